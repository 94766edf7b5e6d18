#pragma once

#include "roadstereo/lucas_kanade.hpp"

namespace roadstereo {

/// As lucas_kanade of roadstereo/lucas_kanade.hpp; writes also the correlation of the pictures along `disparity` in the
/// window around every cell, ⌈W/4⌉×⌈H/4⌉, −1 … 1, 0 where too few pixels have a disparity.
void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned, Image<float>& correlation);

}  // namespace roadstereo

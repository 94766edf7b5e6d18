#pragma once

#include "road/lucas_kanade/gauss_newton.hpp"
#include "roadstereo/lucas_kanade.hpp"

namespace roadstereo {

inline AlignmentSettings alignment_settings(const LucasKanadeOptions& options) {
  return {static_cast<float>(options.max_shift_px), static_cast<float>(options.bias_sigma_px * options.bias_sigma_px)};
}

}  // namespace roadstereo

#pragma once

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/perspective_shift.hpp"
#include "stereo/coarse/pixel_height.hpp"

namespace roadstereo::cuda {

/// Borders of damage, whose place a block knows to its radius only.
struct BorderSettings {
  PerspectiveShift shift;
  PixelHeight heights;
  int block_radius;
};

/// Ends of the prior's intervals (stereo/coarse/prior_interval.hpp).
void find_prior_intervals(ImageView<const float> prior, int factor, const BorderSettings& border, ImageView<float> low,
                          ImageView<float> high, StreamView stream);

}  // namespace roadstereo::cuda

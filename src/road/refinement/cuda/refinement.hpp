#pragma once

#include "core/cuda/stream.hpp"
#include "road/refinement/measured.hpp"
#include "road/refinement/refinement_pass.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// One pass as the kernel takes it (road/refinement/settings.hpp makes its parts).
struct RefinementSettings {
  RefinementPass pass;
  VarianceBounds bounds{};
  float worst_sigma = 1.0F;  ///< pixels
  int smoothing_px = 0;      ///< RefinementOptions::smoothing_px
};

/// Slopes of the heights above the road, pixels of disparity a pixel, along the rows and down the columns.
struct SlopeMaps {
  ImageView<float> across, down;
};

/// Enqueues one pass of refine_disparities (roadstereo/refinement.hpp) on the device. Writes its `slopes`. `error`:
/// standard errors of the last pass, else variances.
void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, const DisparityPlane& road,
                        const RefinementSettings& settings, const SlopeMaps& slopes, ImageView<float> refined,
                        ImageView<float> error, StreamView stream);

}  // namespace roadstereo::cuda

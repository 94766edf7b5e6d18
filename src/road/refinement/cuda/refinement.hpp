#pragma once

#include "core/cuda/stream.hpp"
#include "road/refinement/mean_settings.hpp"
#include "road/refinement/measured.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// RefinementOptions as the kernel takes them (road/refinement/settings.hpp makes its parts).
struct RefinementSettings {
  int radius = 8;  ///< a multiple of `step`, 0 … 32
  int step = 4;
  MeanSettings mean;
  VarianceBounds bounds{};
  float worst_sigma = 1.4F;  ///< pixels
};

/// Enqueues refine_disparities on the device (roadstereo/refinement.hpp).
void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, const DisparityPlane& road,
                        const RefinementSettings& settings, ImageView<float> refined, ImageView<float> sigma,
                        StreamView stream);

}  // namespace roadstereo::cuda

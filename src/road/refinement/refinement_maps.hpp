#pragma once

#include "roadstereo/refinement.hpp"

namespace roadstereo {

/// Disparities, pixels, and their variances, pixels², between two passes of the refinement.
struct RefinementMaps {
  Image<float>& disparity;
  Image<float>& variance;
};

/// As refine_disparities of roadstereo/refinement.hpp, with the caller's maps between passes; they may be of any size.
void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, int pixel_step,
                        const DisparityPlane& road, double effective_samples, const RefinementOptions& options,
                        int threads, const RefinementMaps& between, Image<float>& refined, Image<float>& sigma);

}  // namespace roadstereo

#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "core/cuda/plane.hpp"

namespace roadstereo::cuda {

struct FinishSettings {
  bool project;                ///< the target's winners are those of the reference, projected (project_winners)
  bool left_right_check;       ///< eq. lrc
  float lr_max_diff_px;        ///< δr, pixels²
  float occlusion_variance;    ///< added to what fails the check, pixels²; 0 makes it invalid
  bool sub_pixel;              ///< eq. subpixel
  bool reject_range_boundary;  ///< a winner without two neighbours is invalid
};

/// Left–right consistency and the sub-pixel disparity, row by row. `disparity` holds the offsets of the winners (NaN:
/// no neighbour on one side) and becomes the disparities; `variance` grows where the check fails.
void finish_rows(Plane<const std::int16_t> winner, Plane<std::int16_t> target_winner, Plane<float> disparity,
                 Plane<float> variance, const FinishSettings& settings, cudaStream_t stream);

}  // namespace roadstereo::cuda

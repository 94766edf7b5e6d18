#pragma once

#include "stereo/coarse/scanline.hpp"

namespace roadstereo {

/// Multiplies the weight of every column whose uncertainty is at least `min_uncertainty`, and that has a road and a
/// counterpart, by the plausibility of the road (cost_plausibility). `centre` is the road's disparity, NaN without one.
void apply_road_plausibility(const ScanlineCosts& row, const float* centre, const float* uncertainty, float* weight);

}  // namespace roadstereo

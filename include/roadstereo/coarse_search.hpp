#pragma once

namespace roadstereo {

/// The coarse look at a pair before it is matched: block correlation of the shrunk pair, smoothed along the rows, with
/// the road as the guess where the picture says nothing. It leaves the disparities to search and a prior to lean on.
struct CoarseSearchOptions {
  int factor = 0;                ///< shrinks by this: 2, 4 or 8; 0 takes the smallest that leaves 800 columns or fewer
  int block_radius = 3;          ///< of the correlation block, coarse pixels, 1 … 10
  double ncc_noise_sigma = 1.0;  ///< grey-level noise below which texture is no evidence, 0 … 50
  double step_penalty = 0.15;    ///< cost of a change by one coarse pixel between neighbours, 0 … 10
  double jump_penalty = 1.5;     ///< cost of a larger change; 0 with `step_penalty` 0 does not smooth, 0 … 10
  double road_prior_weight = 0.3;  ///< cost of each coarse pixel away from the road where nothing is known, 0 … 10
  double road_prior_truncation_px =
      5.0;  ///< coarse pixels away at which it stops growing, so that damage can leave the road
  double row_offset_sigma_px =
      0.5;  ///< error of the rows, coarse pixels: texture along the rows does not hold against it
  double half_weight_sigma_px = 0.3;  ///< standard error at which the pull is half as strong, coarse pixels, 0.01 … 10

  void validate() const;
  bool operator==(const CoarseSearchOptions&) const = default;
};

}  // namespace roadstereo

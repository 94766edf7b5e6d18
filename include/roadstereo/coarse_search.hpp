#pragma once

#pragma GCC visibility push(default)
namespace roadstereo {

/// Options of the coarse search: NCC block matching on the downsampled pair, scanline optimisation (1-D semi-global
/// matching) along the rows, and the road plane as prior where texture is weak. It yields a disparity range per tile
/// and the disparity prior of matching.
struct CoarseSearchOptions {
  int factor = 0;                ///< downsampling, 2, 4 or 8, in Pipeline halved where fewer than 4 disparities are
                                 ///< left; 0: the smallest that leaves at most 800 columns, or 8; smaller where fewer
                                 ///< than 7 disparities would be left
  int block_radius = 3;          ///< of the correlation block, coarse pixels, 1 … 10
  double ncc_noise_sigma = 1.0;  ///< standard deviation of the noise, 8-bit grey levels, 0 … 50; 0 is plain NCC
  double step_penalty = 0.15;    ///< cost of a change by one coarse pixel between neighbours, 0 … 10
  double jump_penalty = 1.5;     ///< cost of a larger change, 0 … 10; 0 with `step_penalty` 0 switches smoothing off
  double road_prior_height_m = 0.15;   ///< height above or below the road that costs 1, without texture, 0 … 100; the
                                       ///< cost grows with its square; 0: no prior
  double road_prior_truncation = 1.3;  ///< largest cost of a height, without texture, 0 … 100
  double border_height_m = 0.15;       ///< height steps up to this are left to the matcher, metres, 0 … 100: within a
                                       ///< block's radius of a step its prior is an interval, all of which costs
                                       ///< nothing for steps up to half of this; 0: no intervals
  double row_offset_sigma_px = 0.5;    ///< standard error of the vertical misalignment that is left, coarse pixels,
                                       ///< 0 … 10; it makes edges along the rows uncertain
  double half_weight_sigma_px =
      0.3;  ///< standard error at which the prior has half its weight, coarse pixels, 0.01 … 10

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const CoarseSearchOptions&) const = default;
};

}  // namespace roadstereo
#pragma GCC visibility pop

#pragma once

#include "roadstereo/image.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Options of the rejection of disparities beside the road.
struct OffRoadOptions {
  /// Largest σ of disparities beside the road where the images correlate perfectly, pixels, 0 … 10; a third of it
  /// applies where they do not correlate at all. 0 keeps everything.
  double max_sigma_px = 0.8;

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const OffRoadOptions&) const = default;
};

/// Invalidates disparities beside the road that the images contradict or do not confirm. Such disparities arise because
/// only those near the road are searched, so that a house front or a vehicle gets a wrong one. Cells of 4×4 pixels are
/// compared with `scene`, the map of a coarse search for all that the pair shows, of ⌊W/s⌋×⌊H/s⌋ pixels of s×s, s ≥ 4:
/// residual disparities of the pair with that `shift`, pixels, NaN unknown. A cell is
/// - unconfirmed when the geometric mean of σ around it (36×36 pixels) exceeds max_sigma_px · 3^(ρ − 1), ρ the
///   correlation; above the horizon only where it does not agree with `scene`;
/// - on the road when its mean residual is within s/3 of the road's, and within s/2 of a pixel of `scene` nearby: two
///   columns and one row away at most, one column if the cell is unconfirmed;
/// - contradicted when `scene` is known there and none of its pixels nearby agrees within s/2 (of a cell at another
///   height than the road's, that at its own place).
/// Contradicted and unconfirmed cells and the neighbours of contradicted ones are rejected, except those enclosed by
/// cells on the road and the lower border, such as the dark wall of a pothole.
///
/// `correlation`: of each cell, ⌈W/4⌉×⌈H/4⌉, −1 … 1, as lucas_kanade writes it. `disparity` and `sigma` (W×H, pixels,
/// NaN invalid) become NaN in rejected cells. Masked pixels (`mask`: W×H, not 0 masked, or empty) do not affect the
/// pixels around them; what they hide counts neither as road nor as a way around it. Throws Error when the sizes do not
/// fit.
void reject_off_road(ImageView<const float> correlation, const DisparityPriorView& scene, const PerspectiveShift& shift,
                     ImageView<const std::uint8_t> mask, const OffRoadOptions& options, int threads,
                     Image<float>& disparity, Image<float>& sigma);

}  // namespace roadstereo
#pragma GCC visibility pop

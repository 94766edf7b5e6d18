#pragma once

#include "roadstereo/image.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Options of the rejection of disparities beside the road.
struct OffRoadOptions {
  /// Largest σ there where the pictures agree perfectly, pixels, 0 … 10; a third of it where they do not agree at all.
  /// 0 keeps everything.
  double max_sigma_px = 0.9;
  /// Whether disparities are compared with a coarse search for all that the pair shows, too: reject_inconsistent.
  bool check_scene = true;

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const OffRoadOptions&) const = default;
};

/// Makes disparities beside the road invalid that the pictures do not confirm. Only disparities near the road are
/// searched, so that a house front or a vehicle takes a wrong one: there the pictures correlate badly along the map,
/// and the standard errors are large. A cell of 4×4 pixels is unconfirmed when the geometric mean of σ around it (36×36
/// pixels) exceeds max_sigma_px · 3^(ρ − 1), ρ the correlation. Connected components of such cells that reach the left,
/// right or upper border of the image are rejected, but for their outermost cells: what the road encloses, such as the
/// dark wall of a pothole, stays.
///
/// `correlation`: of each cell, ⌈W/4⌉×⌈H/4⌉, −1 … 1, as lucas_kanade writes it. `disparity` and `sigma` (W×H, pixels,
/// NaN invalid) become NaN in rejected cells. Throws Error when the sizes do not fit.
void reject_off_road(ImageView<const float> correlation, const OffRoadOptions& options, int threads,
                     Image<float>& disparity, Image<float>& sigma);

/// Makes disparities beside the road invalid that a search of the whole scene contradicts. `coarse` is its map, of
/// ⌊W/s⌋×⌊H/s⌋ pixels of s×s, s ≥ 4: residual disparities of the pair with that `shift`, pixels, NaN unknown. A cell of
/// 4×4 pixels is on the road when its mean residual is within s/3 of the road's and within s/2 of that of a coarse
/// pixel around it (four columns and a row to either side), contradicted when it is further than s/2 from the coarse
/// disparity. Contradicted cells and their neighbours become NaN, but for those on the road and those that cells on the
/// road and the lower border enclose, such as a pothole. Throws Error when the sizes do not fit.
void reject_inconsistent(const DisparityPriorView& coarse, const PerspectiveShift& shift, int threads,
                         Image<float>& disparity, Image<float>& sigma);

}  // namespace roadstereo
#pragma GCC visibility pop

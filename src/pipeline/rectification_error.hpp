#pragma once

#include <optional>
#include <vector>

#include "core/cholesky.hpp"
#include "roadstereo/alignment.hpp"
#include "roadstereo/calibration.hpp"

namespace roadstereo {

/// Vertical offsets v_right − v_left that a wrong rectification leaves, and the disparity errors that go with them.
/// With x, y = pixel coordinates from the principal point by the focal length, r² = x² + y², l and r of the views:
///
///     dv / f = offset + scale·y + turn·x_r + k_right·y·r_r² + k_both·y·(r_r² − r_l²)
struct RectificationError {
  static constexpr std::size_t terms = 5;
  double focal_px = 1, cx_px = 0, cy_px = 0, right_cx_px = 0;
  Vector<terms> value{};      ///< offset, scale, turn, k_right, k_both
  Vector<terms> std_error{};  ///< of each
  double scatter_px = 0;      ///< of the points around it, robust standard deviation

  /// Whether the points agree, by `RowAlignment::max_fit_sigma_px`: else they tell nothing of the rectification.
  bool is_known() const { return scatter_px <= RowAlignment::max_fit_sigma_px; }
  /// Whether the term differs from 0 by five standard errors.
  bool is_significant(std::size_t term) const;
  /// Whether one of the distortions does.
  bool has_distortion() const { return is_significant(terms - 2) || is_significant(terms - 1); }
  /// Vertical offset at (u, v) of the left image, pixels, by the significant terms but the offset.
  double slope_px(double u, double v, double disparity) const;
  /// Disparity error at the same point by the significant distortions, pixels.
  double disparity_error_px(double u, double v, double disparity) const;
};

/// Fit by iteratively reweighted least squares (IRLS) with Tukey weights; nothing with fewer than 20 samples. Without
/// a calibration the focal length is the image's width and the principal point its centre.
std::optional<RectificationError> fit_rectification_error(const std::vector<RowSample>& samples, int width, int height,
                                                          const std::optional<StereoCalibration>& calibration);

/// Whether vertical offsets of points change with their place: those of nearest neighbours differ by less than half of
/// what those of any two do (medians). A scene seen from two moments does so, chance matches on texture that repeats,
/// or in noise, do not.
bool neighbours_agree(const std::vector<RowSample>& samples);

}  // namespace roadstereo

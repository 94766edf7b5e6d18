#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// How far a disparity map is from its truth. Figures of errors are NaN when no labelled pixel has a disparity.
struct DisparityScore {
  std::size_t truth_pixels = 0;  ///< labelled pixels inside the mask
  std::size_t given_pixels = 0;  ///< those of them that have a disparity: the paper's m
  double rms_px = 0;             ///< e_r, pixels (eq. e_rms)
  double mean_px = 0;            ///< mean signed error (map − truth), pixels
  double median_px = 0;          ///< median of the absolute error, pixels
  /// e_p as a share, 0 … 1, for each tolerance (eq. e_pep); missing disparities are not part of it.
  std::vector<double> bad_share;
  /// The same with missing disparities counted as errors, over all labelled pixels.
  std::vector<double> bad_or_missing_share;

  /// Share of the labelled pixels that have a disparity; 0 when nothing is labelled.
  double density() const;
};

/// Compares a map with its truth; NaN in the map is missing, NaN in the truth unlabelled, and where `mask` is 0 nothing
/// is compared. An error counts when it is larger than the tolerance (eq. delta_function). Throws Error when sizes
/// differ or a tolerance is negative.
DisparityScore score_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                               const std::optional<ImageView<const std::uint8_t>>& mask,
                               std::span<const double> tolerances_px);

}  // namespace roadstereo

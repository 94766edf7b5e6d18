#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Errors of a disparity map against ground truth. Errors are NaN if no labelled pixel has a disparity.
struct DisparityScore {
  std::size_t labelled_pixels = 0;  ///< pixels of the mask with a ground truth
  std::size_t valid_pixels = 0;     ///< labelled pixels with a disparity: m of the paper
  double density = 0;               ///< share of the labelled pixels with a disparity, 0 … 1; 0 if none is labelled
  double rms_px = 0;                ///< e_r, pixels (eq. (34), e_rms)
  double mean_px = 0;               ///< mean signed error (map − truth), pixels
  double sd_px = 0;                 ///< standard deviation of the signed error: e_r without the mean, pixels
  double median_px = 0;             ///< median absolute error, pixels
  /// e_p for each tolerance, as a share of the valid pixels, 0 … 1 (eq. (33), e_pep).
  std::vector<double> bad_share;
  /// Pixels in error or without a disparity for each tolerance, as a share of the labelled pixels, 0 … 1.
  std::vector<double> bad_or_missing_share;
};

/// Score a W×H disparity map, in pixels, against ground truth. NaN in the map is missing, NaN in the truth is
/// unlabelled; pixels where `mask` is 0 are ignored. A pixel is in error if its absolute error exceeds the tolerance
/// (eq. (35), delta_function). Throws Error when the sizes differ or a tolerance is negative.
DisparityScore score_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                               const std::optional<ImageView<const std::uint8_t>>& mask,
                               std::span<const double> tolerances_px);

}  // namespace roadstereo

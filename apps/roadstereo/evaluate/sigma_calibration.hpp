#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// One disparity with a truth: how wrong it is, and how wrong it says that it may be.
struct ClaimedError {
  float error_px = 0;  ///< magnitude
  float sigma_px = 0;  ///< standard error
};

/// Adds the pixels of the mask that have a disparity and a truth.
void add_claimed_errors(ImageView<const float> disparity, ImageView<const float> sigma, ImageView<const float> truth,
                        ImageView<const std::uint8_t> mask, std::vector<ClaimedError>& claims);

/// How well the standard errors of some pixels keep what they promise. NaN without pixels.
struct SigmaCalibration {
  std::size_t pixels = 0;
  double within_1 = 0;         ///< share whose error is smaller than σ; 0.683 of normal errors
  double within_2 = 0;         ///< smaller than 2σ; 0.954 of normal errors
  double median_error_px = 0;  ///< of |error|
  double median_sigma_px = 0;
};

SigmaCalibration calibrate_sigma(const std::vector<ClaimedError>& claims);

/// The pixels whose standard errors lie next to each other.
struct SigmaBin {
  std::size_t pixels = 0;
  double sigma_px = 0;  ///< predicted: median σ
  double p68_px = 0;    ///< actual: the error that 68.3 % stay below
  double rms_px = 0;    ///< actual: root mean square error
  double within_2 = 0;
};

/// Bins of equally many pixels, from the smallest standard error to the largest. Fewer bins when there are fewer
/// pixels.
std::vector<SigmaBin> sigma_bins(std::vector<ClaimedError> claims, int bins);

}  // namespace roadstereo::cli

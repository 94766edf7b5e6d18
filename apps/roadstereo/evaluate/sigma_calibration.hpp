#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Error and standard error of one disparity.
struct SigmaSample {
  float error_px = 0;  ///< magnitude
  float sigma_px = 0;  ///< standard error
};

/// Add the pixels of the mask with a disparity and a ground truth.
void add_sigma_samples(ImageView<const float> disparity, ImageView<const float> sigma, ImageView<const float> truth,
                       ImageView<const std::uint8_t> mask, std::vector<SigmaSample>& samples);

/// Calibration of standard errors: errors relative to them. NaN without pixels.
struct SigmaCalibration {
  std::size_t pixels = 0;
  double within_1 = 0;         ///< share whose error is smaller than σ; 0.683 of normal errors
  double within_2 = 0;         ///< smaller than 2σ; 0.954 of normal errors
  double median_error_px = 0;  ///< of |error|
  double median_sigma_px = 0;
};

SigmaCalibration calibrate_sigma(const std::vector<SigmaSample>& samples);

/// Pixels with similar standard errors.
struct SigmaBin {
  std::size_t pixels = 0;
  double sigma_px = 0;  ///< predicted: median σ
  double p68_px = 0;    ///< actual: 68.3th percentile of |error|
  double rms_px = 0;    ///< actual: root mean square error
  double within_2 = 0;  ///< share whose error is smaller than 2σ
};

/// Split the samples into `bins` quantile bins of equal size by ascending standard error; fewer if there are fewer
/// samples.
std::vector<SigmaBin> sigma_bins(std::vector<SigmaSample> samples, int bins);

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct BlurOptions {
  std::string scene = "uav";
  double max_px = 20;                                ///< maximum length of the motion blur, pixels, up to 100
  int steps = 11;                                    ///< number of lengths from 0 to max_px, 2 … 1000
  std::vector<double> directions_deg = {0, 45, 90};  ///< 0 is along the rows, the direction of the disparities
  double noise_grey = 2;                             ///< standard deviation, 8-bit grey levels, added after the blur
  MethodSettings methods;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Score of one method on one blurred pair, over the pixels that both cameras see.
struct BlurTrial {
  std::string method;  ///< a preset or one of OpenCV's matchers
  double length_px = 0;
  double direction_deg = 0;
  double density = 0;         ///< share of the pixels with a disparity
  double rms_px = 0;          ///< e_r (eq. (34), e_rms)
  double bad_or_missing = 0;  ///< share of the pixels without a disparity or with an error above 1 px
};

/// Names of the compared methods.
const std::vector<std::string>& blur_methods();

/// Run every method for every length and direction. OpenCV's matcher gets the target image as transformed by the
/// default preset, and searches the same number of disparities.
std::vector<BlurTrial> run_blur_trials(const BlurOptions& options);

/// Mean over the directions for one method and length.
BlurTrial mean_over_directions(const std::vector<BlurTrial>& trials, const std::string& method, double length_px);

/// Lengths of the motion blur, pixels.
std::vector<double> blur_lengths(const BlurOptions& options);

}  // namespace roadstereo::cli

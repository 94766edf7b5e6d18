#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct BlurOptions {
  std::string scene = "uav";
  double longest_px = 20;                            ///< motion while the shutter is open, pixels
  int steps = 11;                                    ///< lengths from 0 to the longest
  std::vector<double> directions_deg = {0, 45, 90};  ///< 0 is along the rows, the direction of the disparities
  double noise_grey = 2;                             ///< standard deviation, grey levels, added after the blur
  MethodSettings methods;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// One method on one blurred pair, over the pixels that both cameras see.
struct BlurTrial {
  std::string method;  ///< a preset or one of OpenCV's matchers
  double length_px = 0;
  double direction_deg = 0;
  double density = 0;  ///< share of the pixels with a disparity
  double rms_px = 0;   ///< e_r (eq. e_rms)
  double wrong = 0;    ///< share of the pixels that are wrong by more than 1 px or missing
};

/// The methods that are tried.
const std::vector<std::string>& blur_methods();

/// Every method on every length and direction. OpenCV's matcher gets the target that the default preset has
/// transformed, and searches as many disparities.
std::vector<BlurTrial> try_blur(const BlurOptions& options);

/// The mean over the directions for one method and length.
BlurTrial mean_over_directions(const std::vector<BlurTrial>& trials, const std::string& method, double length_px);

/// The lengths that are tried.
std::vector<double> blur_lengths(const BlurOptions& options);

}  // namespace roadstereo::cli

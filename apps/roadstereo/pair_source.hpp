#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Files of a pair.
struct PairFiles {
  std::string left;
  std::string right;                     ///< empty only with a disparity map
  std::vector<std::string> calibration;  ///< empty, one file, or two: left and right
  std::string disparity{};               ///< map of the left image that replaces matching; empty: none
};

/// A rectified pair.
struct StereoPair {
  Frame left;
  Frame right;             ///< empty if there is no file
  Image<float> disparity;  ///< of the file; empty if there is none
  std::optional<StereoCalibration> calibration;
  std::string calibration_format;       ///< empty without a calibration
  bool rectified_here = false;          ///< rectified by this program
  std::vector<std::string> warnings{};  ///< of the calibration
  double white_level = 0;               ///< sample value of white; 0: maximum of the sample type
};

/// Reads the images, the disparity map and the calibration, and rectifies the pair if necessary, by `threads`
/// workers; 0 takes all cores. Throws Error naming the file.
StereoPair read_pair(const PairFiles& files, int threads = 0);

}  // namespace roadstereo::cli

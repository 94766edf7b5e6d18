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
  std::string right;
  std::vector<std::string> calibration;  ///< empty, one file, or left and right ROS camera_info
};

/// A rectified pair.
struct StereoPair {
  Frame left;
  Frame right;
  std::optional<StereoCalibration> calibration;
  std::string calibration_format;  ///< empty without a calibration
  bool rectified_here = false;     ///< rectified by this program
  double white_level = 0;          ///< sample value of white; 0: maximum of the sample type
};

/// Reads both images and the calibration, and rectifies the pair if necessary. Throws Error naming the file.
StereoPair read_pair(const PairFiles& files);

}  // namespace roadstereo::cli

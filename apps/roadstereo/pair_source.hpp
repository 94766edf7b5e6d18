#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Where a pair comes from.
struct PairFiles {
  std::string left;
  std::string right;
  std::vector<std::string> calibration;  ///< none, one file, or the left and the right ROS camera_info
};

/// A pair ready for the pipeline.
struct StereoPair {
  Frame left;
  Frame right;
  std::optional<StereoCalibration> calibration;
  std::string calibration_format;  ///< empty without a calibration
  bool rectified_here = false;     ///< the files were not rectified yet
  double white_level = 0;          ///< sample value of white; 0: the largest value of the sample type
};

/// Reads both images and the calibration, and rectifies the pair when it is not yet. Throws Error naming the
/// file.
StereoPair read_pair(const PairFiles& files);

}  // namespace roadstereo::cli

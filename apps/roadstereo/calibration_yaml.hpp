#pragma once

#include <string>

#include "roadstereo/calibration.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::cli {

/// Returns a calibration as plain YAML, which io::read_calibration reads.
std::string plain_yaml(const StereoCalibration& calibration);

/// Returns that of an unrectified rig as OpenCV's YAML, likewise.
std::string opencv_yaml(const io::StereoRig& rig);

}  // namespace roadstereo::cli

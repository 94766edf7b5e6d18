#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "roadstereo/calibration.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::python {

/// Returns the calibration of a Calibration or None. Throws Error for the rig of unrectified pairs,
/// pybind11::type_error for other types.
std::optional<StereoCalibration> optional_calibration(const pybind11::object& calibration);

/// Returns a Calibration, or the StereoRig of unrectified pairs. Throws Error naming the source if it has several.
pybind11::object calibration_object(const io::CalibrationFile& file, const std::string& source);

}  // namespace roadstereo::python

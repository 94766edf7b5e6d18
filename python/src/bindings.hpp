#pragma once

#include <pybind11/pybind11.h>

namespace roadstereo::python {

// Each adds a part of the library to the module.
void bind_calibration(pybind11::module_& module);
void bind_damage(pybind11::module_& module);
void bind_device_maps(pybind11::module_& module);
void bind_frame_result(pybind11::module_& module);
void bind_frame_source(pybind11::module_& module);
void bind_image_files(pybind11::module_& module);
void bind_odometry(pybind11::module_& module);
void bind_pipeline(pybind11::module_& module);
void bind_point_cloud(pybind11::module_& module);
void bind_road_map(pybind11::module_& module);

}  // namespace roadstereo::python

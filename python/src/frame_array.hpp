#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "roadstereo/image.hpp"

namespace roadstereo::python {

/// Returns the view of an array of uint8 or uint16, (H, W) or (H, W, 3 or 4), without a copy. Rows may be any number of
/// bytes apart and run upwards; the samples of three channels may be reversed (`image[..., ::-1]`). `order` is that of
/// the channels, "bgr" or "rgb". The array must outlive the view. `name` begins the messages.
/// Throws pybind11::type_error for another object or sample type, Error for another shape, layout or order.
FrameView frame_view(const pybind11::object& array, const std::string& name, const std::string& order);

/// Copies an array of any layout, otherwise as `frame_view`.
Frame copy_frame(const pybind11::object& array, const std::string& name, const std::string& order);

/// Returns the array of a frame, whose samples it takes: (H, W), or (H, W, 3 or 4) in the order blue, green, red.
pybind11::array frame_array(Frame frame);

}  // namespace roadstereo::python

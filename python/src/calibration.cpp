#include "calibration.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "frame_array.hpp"
#include "map_array.hpp"
#include "record.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/rectification.hpp"
#include "type_name.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

template <std::size_t Count>
std::array<double, Count> numbers(const char* name, const Numbers& given) {
  if (given.size() != static_cast<py::ssize_t>(Count))
    fail(name, " has ", given.size(), " values; it must have ", Count);
  std::array<double, Count> values{};
  std::copy_n(given.data(), Count, values.begin());
  return values;
}

io::StereoRig make_rig(const Numbers& left_matrix, const std::vector<double>& left_distortion,
                       const Numbers& right_matrix, const std::vector<double>& right_distortion,
                       const Numbers& rotation, const Numbers& translation_m, bool fisheye, int width, int height) {
  return {numbers<9>("left_matrix", left_matrix),
          left_distortion,
          numbers<9>("right_matrix", right_matrix),
          right_distortion,
          numbers<9>("rotation", rotation),
          numbers<3>("translation_m", translation_m),
          fisheye,
          width,
          height};
}

void bind_stereo_calibration(py::module_& module) {
  Record<StereoCalibration> record(module, "Calibration",
                                   "Calibration of a rectified stereo rig: two pinhole cameras with common rows.\n\n"
                                   "Camera frame: x right, y down, z forward, metres, origin at the left camera.");
  record.field("focal_px", &StereoCalibration::focal_px, "Focal length, pixels.")
      .field("cx_px", &StereoCalibration::cx_px, "Column of the principal point of the left image, pixels.")
      .field("cy_px", &StereoCalibration::cy_px, "Row of the principal point, pixels.")
      .field("baseline_m", &StereoCalibration::baseline_m, "Distance between the cameras, metres.")
      .field("disparity_offset_px", &StereoCalibration::disparity_offset_px,
             "Column of the right principal point minus that of the left one, pixels.")
      .field("width", &StereoCalibration::width, "Image width of the calibration, pixels; 0: unknown.")
      .field("height", &StereoCalibration::height, "Image height of the calibration, pixels; 0: unknown.");
  record.type()
      .def(py::init([](double focal_px, double cx_px, double cy_px, double baseline_m, double disparity_offset_px,
                       int width, int height) {
             return StereoCalibration{focal_px, cx_px, cy_px, baseline_m, disparity_offset_px, width, height};
           }),
           py::arg("focal_px"), py::arg("cx_px"), py::arg("cy_px"), py::arg("baseline_m"),
           py::arg("disparity_offset_px") = 0.0, py::arg("width") = 0, py::arg("height") = 0)
      .def("depth_m", py::vectorize(&StereoCalibration::depth_m), py::arg("disparity_px"),
           "Return the depth Z = f·b / (d + doffs) of a disparity or of an array of them, metres; NaN stays NaN.")
      .def("point_m", &StereoCalibration::point_m, py::arg("u"), py::arg("v"), py::arg("disparity_px"),
           "Return the point [x, y, z] seen at column u and row v with this disparity, metres, camera frame.");
}

void bind_rig(py::module_& module) {
  using Rig = io::StereoRig;
  Record<Rig> record(module, "StereoRig", "Calibration of an unrectified stereo rig; `Rectifier` rectifies its pairs.");
  record
      .field(
          "left_matrix", [](const Rig& rig) { return matrix<3, 3>(rig.left_matrix); }, "K1, (3, 3), pixels.")
      .field("left_distortion", &Rig::left_distortion, "D1 in OpenCV's order; empty: none.")
      .field(
          "right_matrix", [](const Rig& rig) { return matrix<3, 3>(rig.right_matrix); }, "K2, (3, 3), pixels.")
      .field("right_distortion", &Rig::right_distortion, "D2 in OpenCV's order; empty: none.")
      .field(
          "rotation", [](const Rig& rig) { return matrix<3, 3>(rig.rotation); },
          "R, (3, 3), left camera to right camera.")
      .field("translation_m", &Rig::translation_m, "T, left camera to right camera, metres.")
      .field("fisheye", &Rig::fisheye, "Whether the distortion is OpenCV's fisheye model.")
      .field("width", &Rig::width, "Image width, pixels; 0: unknown.")
      .field("height", &Rig::height, "Image height, pixels; 0: unknown.");
  record.type().def(py::init(&make_rig), py::arg("left_matrix"), py::arg("left_distortion"), py::arg("right_matrix"),
                    py::arg("right_distortion"), py::arg("rotation"), py::arg("translation_m"),
                    py::arg("fisheye") = false, py::arg("width") = 0, py::arg("height") = 0);
}

std::pair<py::array, py::array> rectify(const io::Rectifier& rectifier, const py::object& left, const py::object& right,
                                        const std::string& order) {
  const Frame left_frame = copy_frame(left, "left", order);
  const Frame right_frame = copy_frame(right, "right", order);
  io::RectifiedPair pair = [&] {
    const py::gil_scoped_release release;
    return rectifier.rectify(left_frame, right_frame);
  }();
  return {frame_array(std::move(pair.left)), frame_array(std::move(pair.right))};
}

void bind_rectifier(py::module_& module) {
  py::class_<io::Rectifier>(module, "Rectifier",
                            "Undistorts and rectifies pairs of one rig. The pixel maps are computed once.")
      .def(py::init<const io::StereoRig&, int, int, int>(), py::arg("rig"), py::arg("width"), py::arg("height"),
           py::arg("threads") = 0, py::call_guard<py::gil_scoped_release>(),
           "Compute the maps for frames of this size, pixels. threads: worker threads; 0: all cores.\n\n"
           "Raises Error if the rig has another size, or if its right camera is not to the right of the left one.")
      .def_property_readonly("calibration", &io::Rectifier::calibration, "Calibration of the rectified pairs.")
      .def("rectify", &rectify, py::arg("left"), py::arg("right"), py::arg("order") = "bgr",
           "Return the rectified pair as two arrays of the same shape and type; colour is in the order BGR.\n\n"
           "Raises Error if a frame has another size than the rectifier.");
}

/// Throws Error if the file is for images of another size.
void require_size(const io::CalibrationFile& file, const std::string& source, int width, int height) {
  const auto check = [&](const auto& calibration) {
    if (!calibration || calibration->width == 0) return;
    if (calibration->width == width && calibration->height == height) return;
    fail(source, ": the calibration is for ", calibration->width, "×", calibration->height, " pixels; size is ", width,
         "×", height);
  };
  check(file.rectified);
  check(file.rig);
}

}  // namespace

std::optional<StereoCalibration> optional_calibration(const py::object& calibration) {
  if (calibration.is_none()) return std::nullopt;
  if (py::isinstance<io::StereoRig>(calibration)) {
    fail("the calibration is that of an unrectified rig: rectify the pairs with a Rectifier and use its calibration");
  }
  if (!py::isinstance<StereoCalibration>(calibration)) {
    throw py::type_error("calibration is of type " + type_name(calibration) + "; it must be a Calibration or None");
  }
  return calibration.cast<StereoCalibration>();
}

py::object calibration_object(const io::CalibrationFile& file, const std::string& source) {
  if (file.rig) return py::cast(*file.rig);
  if (file.rectified) return py::cast(*file.rectified);
  std::string sizes;
  for (const io::StereoRig& rig : file.rigs) {
    sizes += (sizes.empty() ? "" : ", ") + std::to_string(rig.width) + "×" + std::to_string(rig.height);
  }
  fail(source, ": ", file.format, " has a rig for each size of the images: give one of them as size: ", sizes);
}

void bind_calibration(py::module_& module) {
  bind_stereo_calibration(module);
  bind_rig(module);
  bind_rectifier(module);
  module.def(
      "read_calibration",
      [](const std::filesystem::path& path, const std::optional<std::filesystem::path>& right_path,
         const std::optional<std::array<int, 2>>& size) {
        io::CalibrationFile file = io::read_calibration(path.string(), right_path ? right_path->string() : "");
        if (size) {
          file.select_size((*size)[0], (*size)[1], path.string());
          require_size(file, path.string(), (*size)[0], (*size)[1]);
        }
        return calibration_object(file, path.string());
      },
      py::arg("path"), py::arg("right_path") = py::none(), py::arg("size") = py::none(),
      "Read a calibration file: a Calibration, or a StereoRig if its pairs must be rectified first.\n\n"
      "The format is recognised by content: plain YAML, OpenCV stereo (YAML or XML), ROS camera_info and EuRoC\n"
      "sensor.yaml (two files, left and right), Kalibr, ZED, RealSense, DepthAI, COLMAP, KITTI, Middlebury or K.txt.\n"
      "Files of ZED and RealSense cameras have a rig for each size of the images, (width, height) in pixels: give "
      "`size`.\n"
      "Raises Error naming the file and the bad value, or the size that the file is for if `size` is another.");
}

}  // namespace roadstereo::python

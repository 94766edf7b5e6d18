#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "frame_array.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

py::array read_frame(const std::filesystem::path& path) {
  Frame frame = [&path] {
    const py::gil_scoped_release release;
    return io::read_frame(path.string());
  }();
  return frame_array(std::move(frame));
}

py::array_t<float> read_disparity(const std::filesystem::path& path) {
  const Image<float> map = [&path] {
    const py::gil_scoped_release release;
    return io::read_disparity(path.string());
  }();
  return py::array_t<float>({map.height(), map.width()}, map.row(0));
}

}  // namespace

void bind_image_files(py::module_& module) {
  module.def("read_frame", &read_frame, py::arg("path"),
             "Read a PNG, JPEG, TIFF or PGM/PPM image: (H, W), or (H, W, 3 or 4) in the order BGR; uint8 or uint16.\n\n"
             "Raises Error naming the file.");
  module.def("read_disparity", &read_disparity, py::arg("path"),
             "Read a disparity map, (H, W) float32, pixels, NaN invalid: float TIFF, PFM or 16-bit KITTI PNG.\n\n"
             "Raises Error naming the file.");
  module.def(
      "find_white_level",
      [](const py::object& left, const py::object& right) {
        return io::find_white_level(frame_view(left, "left", "bgr"), frame_view(right, "right", "bgr"));
      },
      py::arg("left"), py::arg("right"),
      "Return the sample value of white of a pair of uint16 whose camera has fewer than 16 bits.\n\n"
      "It is the smallest of 1023, 4095, 16383 and 65535 that no sample exceeds; 255 for uint8. The command line sets\n"
      "the option white_level to it.");
}

}  // namespace roadstereo::python

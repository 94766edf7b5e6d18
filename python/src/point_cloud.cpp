#include "roadstereo/point_cloud.hpp"

#include <pybind11/numpy.h>

#include <cstddef>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "frame_array.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;
using Disparities = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// (N, 3), a copy.
template <class T>
py::array_t<T> triples(const std::vector<std::array<T, 3>>& values) {
  return py::array_t<T>({static_cast<py::ssize_t>(values.size()), py::ssize_t{3}},
                        values.empty() ? nullptr : values.front().data());
}

py::tuple cloud(const Disparities& disparity, const StereoCalibration& calibration, const py::object& left,
                const std::string& order, double white_level) {
  if (disparity.ndim() != 2) fail("disparity has ", disparity.ndim(), " dimensions; it must have 2: (height, width)");
  const ImageView<const float> map(disparity.data(), static_cast<int>(disparity.shape(1)),
                                   static_cast<int>(disparity.shape(0)));
  calibration.validate(map.width(), map.height(), "calibration");
  if (left.is_none()) return py::make_tuple(triples(cloud_from_disparity(map, calibration).points), py::none());
  const PointCloud coloured = cloud_from_disparity(map, frame_view(left, "left", order), white_level, calibration);
  return py::make_tuple(triples(coloured.points), triples(coloured.colours));
}

constexpr const char* cloud_doc =
    R"(Triangulate a disparity map: return points and their colours.

disparity is (H, W), pixels; points is (N, 3) float32, metres, camera frame: x right, y down, z forward, row by row.
Pixels without a disparity of at least 1 px (0 at infinity) are left out. With the left image, an array as `process`
takes it, colours is (N, 3) uint8, red, green, blue; else None. white_level is that of the pipeline's options.)";

}  // namespace

void bind_point_cloud(py::module_& module) {
  module.def("cloud_from_disparity", &cloud, py::arg("disparity"), py::arg("calibration"), py::arg("left") = py::none(),
             py::arg("order") = "bgr", py::arg("white_level") = 0.0, cloud_doc);
}

}  // namespace roadstereo::python

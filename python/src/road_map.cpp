#include "roadstereo/road_map.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "frame_array.hpp"
#include "map_array.hpp"
#include "option_values.hpp"
#include "processed_frame.hpp"
#include "record.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/grey_scale.hpp"
#include "roadstereo/map_damage.hpp"
#include "roadstereo/pipeline.hpp"
#include "serial_calls.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;
using PoseArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

const StereoCalibration& map_calibration(const ProcessedFrame& frame) {
  if (!frame.calibration) fail("the result has no calibration; a map needs one");
  return *frame.calibration;
}

/// A new folder for tiles, where none is named.
std::filesystem::path temporary_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "roadstereo_map_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) fail(name, ": this folder cannot be made");
  return name;
}

const DisparityPlane& road_plane(const ProcessedFrame& frame) {
  if (!frame.result.roll_found) fail("the result has no road; a map needs one");
  return frame.result.geometry.plane;
}

RigidTransform transform_of(const PoseArray& pose) {
  const bool square = pose.ndim() == 2 && pose.shape(0) == 4 && pose.shape(1) == 4;
  if (!square && !(pose.ndim() == 2 && pose.shape(0) == 3 && pose.shape(1) == 4)) {
    std::string shape;
    for (py::ssize_t k = 0; k < pose.ndim(); ++k) shape += (k > 0 ? ", " : "") + std::to_string(pose.shape(k));
    fail("camera_to_map has the shape (", shape, "); it must be (3, 4) or (4, 4)");
  }
  if (square) {
    constexpr std::array<double, 4> last{0, 0, 0, 1};
    const double* const row = pose.data() + RigidTransform{}.size();
    if (!std::equal(last.begin(), last.end(), row)) {
      fail("the last row of camera_to_map is ", row[0], ", ", row[1], ", ", row[2], ", ", row[3],
           "; it must be 0, 0, 0, 1");
    }
  }
  RigidTransform transform;
  std::copy_n(pose.data(), transform.size(), transform.begin());
  return transform;
}

/// A map that any thread may use; calls wait for each other, without the interpreter's lock.
class SharedRoadMap {
 public:
  SharedRoadMap(const std::filesystem::path& folder, const RoadMapOptions& options) : map_(folder, options) {}

  std::size_t add(const ProcessedFrame& frame, const PoseArray& camera_to_map, const py::object& left,
                  const std::string& order) {
    require_maps(frame, "map: the maps of the result");
    const FrameResult& result = frame.result;
    const GreyImage& grey = result.grey;
    MapFrame seen{result.disparity,
                  result.sigma,
                  FrameView::grey16(reinterpret_cast<const std::uint16_t*>(grey.row(0)), grey.width(), grey.height()),
                  static_cast<double>(grey_max),
                  road_plane(frame),
                  map_calibration(frame),
                  transform_of(camera_to_map)};
    if (!left.is_none()) {
      seen.image = frame_view(left, "left", order);
      seen.white_level = frame.options.white_level;
    }
    return call_([&] { return map_.add(seen); });
  }
  MapRaster read(const std::optional<std::array<int, 4>>& box) {
    return call_([&] { return map_.read(box ? MapBox{(*box)[0], (*box)[1], (*box)[2], (*box)[3]} : map_.bounds()); });
  }
  std::array<int, 4> bounds() {
    const MapBox box = call_([&] { return map_.bounds(); });
    return {box.i0, box.j0, box.columns, box.rows};
  }
  double cell_m() const { return map_.options().cell_m; }
  std::vector<MapDamage> find_damage(const DamageOptions& options) {
    return call_([&] { return find_map_damage(map_, options); });
  }

 private:
  SerialCalls call_;
  RoadMap map_;
};

std::unique_ptr<SharedRoadMap> make_road_map(const std::optional<std::filesystem::path>& folder, double cell_m,
                                             double max_above_m, double max_below_m, int threads) {
  RoadMapOptions options;
  options.cell_m = cell_m;
  options.max_above_m = max_above_m;
  options.max_below_m = max_below_m;
  options.threads = threads;
  options.validate();
  return std::make_unique<SharedRoadMap>(folder ? *folder : temporary_folder(), options);
}

std::vector<MapDamage> find_damage_in(SharedRoadMap& map, const py::object& options, const py::kwargs& keywords) {
  PipelineOptions all = preset("default");
  set_damage_options(all, options, keywords, false);
  all.validate();
  return map.find_damage(all.damage);
}

template <auto Raster>
py::object raster_map(const py::object& self) {
  return map_array(self.cast<const MapRaster&>().*Raster, self);
}

void bind_raster(py::module_& module) {
  py::class_<MapRaster>(module, "MapRaster",
                        "Cells of a map, north up: row 0 has the largest y. Its arrays are read-only views, which keep "
                        "its memory alive.")
      .def_property_readonly(
          "box",
          [](const MapRaster& raster) {
            return std::array{raster.box.i0, raster.box.j0, raster.box.columns, raster.box.rows};
          },
          "[i0, j0, columns, rows]: cell (i, j) covers i … i + 1 times j … j + 1 cell sizes along x and y.")
      .def_property_readonly("height", raster_map<&MapRaster::height>,
                             "(H, W) float32, metres above z = 0; NaN: no measurement.")
      .def_property_readonly("sigma", raster_map<&MapRaster::sigma>,
                             "Standard errors of `height`, (H, W) float32, metres; NaN likewise.")
      .def_property_readonly(
          "colour",
          [](const py::object& self) {
            const auto& colour = self.cast<const MapRaster&>().colour;
            const py::array_t<std::uint8_t> array({colour.height(), colour.width(), 3},
                                                  reinterpret_cast<const std::uint8_t*>(colour.row(0)), self);
            array.attr("flags").attr("writeable") = false;
            return array;
          },
          "(H, W, 3) uint8, red, green, blue; black where `views` is 0.")
      .def_property_readonly("views", raster_map<&MapRaster::views>, "Frames that agree on the height, (H, W) uint16.");
}

constexpr const char* map_doc =
    R"(A 2.5-D map of a road: height, its standard error and colour in square cells, z up.

Frames are fused cell by cell. Several threads may use one, one after the other.)";

constexpr const char* map_init_doc =
    R"(Make a map, which keeps its tiles in a folder and removes them at the end.

folder: new, or with nothing but tiles that another map has left, which are removed; by default a temporary one.
cell_m: side of a cell, metres; suggested_cell_m names one. max_above_m, max_below_m: points higher above or deeper below
the frame's road are left out. threads: 0 takes all cores.)";

constexpr const char* map_add_doc =
    R"(Fuse a frame; return the number of cells that it measures.

camera_to_map is (3, 4) or (4, 4), a rigid motion, metres, z up. The picture of the map is that of left, an array as
`process` takes it, or without one the grey levels of the result. Raises Error for a result without a road or a
calibration, for one whose maps were left on the device, and for another size.)";

}  // namespace

void bind_road_map(py::module_& module) {
  bind_raster(module);
  Record<MapDamage>(module, "MapDamage", "Damage at a position of a map.")
      .field("damage", &MapDamage::damage, "The damage; its pixels are those of where it was found.")
      .field("at_m", &MapDamage::at_m, "[x, y] of its centroid in the map, metres.")
      .field("length_angle_rad", &MapDamage::length_angle_rad,
             "From the map's x axis to its longer side, positive towards y, radians.");
  const RoadMapOptions usual;
  py::class_<SharedRoadMap>(module, "RoadMap", map_doc)
      .def(py::init(&make_road_map), py::arg("folder") = py::none(), py::kw_only(), py::arg("cell_m") = usual.cell_m,
           py::arg("max_above_m") = usual.max_above_m, py::arg("max_below_m") = usual.max_below_m,
           py::arg("threads") = usual.threads, map_init_doc)
      .def("add", &SharedRoadMap::add, py::arg("result"), py::arg("camera_to_map"), py::arg("left") = py::none(),
           py::arg("order") = "bgr", map_add_doc)
      .def("read", &SharedRoadMap::read, py::arg("box") = py::none(),
           "Return the cells of a box [i0, j0, columns, rows], or of `bounds`; those outside the map are empty. It "
           "takes\n"
           "13 bytes a cell. Raises Error for a box of negative size or of more than 2²⁸ cells.")
      .def("find_damage", &find_damage_in, py::arg("options") = py::none(),
           "Find damage in the heights of the map. The options are those of `find_damage`.")
      .def_property_readonly("bounds", &SharedRoadMap::bounds, "Smallest box with all cells: [i0, j0, columns, rows].")
      .def_property_readonly("cell_m", &SharedRoadMap::cell_m, "Side of a cell, metres.");
  module.def(
      "camera_to_road",
      [](const ProcessedFrame& frame) {
        return matrix<3, 4>(camera_to_road(road_plane(frame), map_calibration(frame)));
      },
      py::arg("result"),
      "Return the transformation from the camera to axes on its road, (3, 4): origin at the foot of the camera, x to\n"
      "its right, y ahead, z up. Raises Error for a result without a road or a calibration.");
  module.def(
      "suggested_cell_m",
      [](const ProcessedFrame& frame) {
        const Image<float>& map = frame.result.disparity;
        return suggested_cell_m(road_plane(frame), map_calibration(frame), map.width(), map.height());
      },
      py::arg("result"), "Return a side of cells for a map of such frames, metres.");
}

}  // namespace roadstereo::python

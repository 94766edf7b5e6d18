#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::python {
namespace {

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const EngineInfo& engine : engines()) names.push_back(engine.name);
  return names;
}

}  // namespace
}  // namespace roadstereo::python

PYBIND11_MODULE(_roadstereo, module) {
  namespace py = pybind11;
  namespace python = roadstereo::python;
  module.attr("__version__") = roadstereo::version;
  py::register_exception<roadstereo::Error>(module, "Error", PyExc_RuntimeError).attr("__doc__") =
      "Bad input or a failed operation. The message is one sentence: which value, and what it must be.";
  module.def("engine_names", python::engine_names,
             "Return the matching engines of this build that this machine can run, fastest first.");
  python::bind_calibration(module);
  python::bind_image_files(module);
  python::bind_frame_source(module);
  python::bind_frame_result(module);
  python::bind_device_maps(module);
  python::bind_pipeline(module);
  python::bind_damage(module);
  python::bind_odometry(module);
  python::bind_point_cloud(module);
  python::bind_road_map(module);
}

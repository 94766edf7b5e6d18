#include <pybind11/pybind11.h>

#include <string>

#include "bindings.hpp"
#include "dlpack.hpp"
#include "record.hpp"
#include "roadstereo/device.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

DLDevice device_of(const DeviceMaps& maps) {
  if (maps.device < 0) return {kDLCPU, 0};
  return {kDLCUDA, maps.device};
}

DeviceMap float_map(const DeviceMaps& maps, const float* data) {
  return {data, {kDLFloat, 32, 1}, maps.width, maps.height, device_of(maps), maps.owner};
}

DeviceMap grey_map(const DeviceMaps& maps) {
  return {maps.grey, {kDLInt, 16, 1}, maps.width, maps.height, device_of(maps), maps.owner};
}

[[noreturn]] void fail_buffer(const char* message) {
  PyErr_SetString(PyExc_BufferError, message);
  throw py::error_already_set();
}

py::tuple dlpack_device(const DeviceMap& map) {
  return py::make_tuple(static_cast<int>(map.device.device_type), map.device.device_id);
}

/// The frame is complete: no stream has to wait for it. A consumer that knows a later version of DLPack takes this one.
py::capsule dlpack(const DeviceMap& map, const py::object&, const py::object&, const py::object& dl_device,
                   const py::object& copy) {
  if (!dl_device.is_none() && !dl_device.equal(dlpack_device(map))) {
    fail_buffer("a map is handed out on its own device only");
  }
  if (py::bool_(copy)) fail_buffer("a map is handed out without a copy only");
  return dlpack_capsule(map);
}

std::string text_of(const DeviceMap& map) {
  const std::string place =
      map.device.device_type == kDLCUDA ? "GPU " + std::to_string(map.device.device_id) : "emulated on the host";
  return "DeviceMap(" + std::to_string(map.width) + "×" + std::to_string(map.height) + " pixels, " + place + ")";
}

constexpr const char* map_doc =
    R"(A map in the memory of a GPU, for libraries that know DLPack: torch.from_dlpack(map), cupy.from_dlpack(map).

What they make of it keeps the memory, without a copy.)";

constexpr const char* maps_doc =
    R"(Maps of one pair in the memory of a GPU.

They stay as they are, whatever becomes of the pipeline; later pairs take other memory while they or tensors of them
live. Tensors of one map share its memory.)";

}  // namespace

void bind_device_maps(py::module_& module) {
  py::class_<DeviceMap> map(module, "DeviceMap", map_doc);
  map.def_property_readonly(
         "shape", [](const DeviceMap& of) { return py::make_tuple(of.height, of.width); }, "(H, W), pixels.")
      .def("__dlpack_device__", &dlpack_device, "Return the type of the device, 2 for CUDA, and its number.")
      .def("__dlpack__", &dlpack, py::kw_only(), py::arg("stream") = py::none(), py::arg("max_version") = py::none(),
           py::arg("dl_device") = py::none(), py::arg("copy") = py::none(), "Return a capsule of DLPack.");
  set_repr(map, &text_of);
  py::class_<DeviceMaps>(module, "DeviceMaps", maps_doc)
      .def_property_readonly(
          "disparity", [](const DeviceMaps& maps) { return float_map(maps, maps.disparity); },
          "Disparities of the left image, float32, pixels; NaN invalid.")
      .def_property_readonly(
          "sigma", [](const DeviceMaps& maps) { return float_map(maps, maps.sigma); },
          "Standard errors of `disparity`, float32, pixels; NaN where it is invalid.")
      .def_property_readonly(
          "transformed", [](const DeviceMaps& maps) { return float_map(maps, maps.transformed); },
          "Transformed disparities, float32, pixels; NaN invalid.")
      .def_property_readonly("grey", grey_map, "The left image, int16, sixteenths of a grey level.");
}

}  // namespace roadstereo::python

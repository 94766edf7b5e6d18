#include "roadstereo/pipeline.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "bindings.hpp"
#include "calibration.hpp"
#include "frame_array.hpp"
#include "option_values.hpp"
#include "processed_frame.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/options.hpp"
#include "serial_calls.hpp"
#include "type_name.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

/// A pipeline that any thread may use; calls wait for each other, without the interpreter's lock.
class SharedPipeline {
 public:
  SharedPipeline(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
      : pipeline_(options, calibration) {}

  std::unique_ptr<ProcessedFrame> process(const py::object& left, const py::object& right, const std::string& order) {
    const FrameView left_view = frame_view(left, "left", order);
    const FrameView right_view = frame_view(right, "right", order);
    auto frame = std::make_unique<ProcessedFrame>();
    call_([&] {
      frame->calibration = pipeline_.calibration();
      frame->options = pipeline_.options();
      pipeline_.process(left_view, right_view, frame->result);
    });
    return frame;
  }

  void set_mask(const py::object& mask) {
    if (mask.is_none()) return call_([&] { pipeline_.set_mask({}); });
    const std::string wanted = "; it must be None or a numpy array of bool or uint8";
    if (!py::isinstance<py::array>(mask)) throw py::type_error("mask is of type " + type_name(mask) + wanted);
    const auto given = py::reinterpret_borrow<py::array>(mask);
    const py::dtype type = given.dtype();
    if (type.itemsize() != 1 || (type.kind() != 'b' && type.kind() != 'u')) {
      throw py::type_error("mask has samples of type " + py::str(py::handle(type)).cast<std::string>() + wanted);
    }
    if (given.ndim() != 2) fail("mask has ", given.ndim(), " dimensions; it must have 2: (height, width)");
    const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast> bytes(given);
    const ImageView<const std::uint8_t> view(bytes.data(), static_cast<int>(bytes.shape(1)),
                                             static_cast<int>(bytes.shape(0)));
    call_([&] { pipeline_.set_mask(view); });
  }

  void warm_up(int width, int height) {
    call_([&] { pipeline_.warm_up(width, height); });
  }
  void reset() {
    call_([&] { pipeline_.reset(); });
  }

  void set_device_options(bool download) {
    call_([&] { pipeline_.set_device_options({.download = download}); });
  }
  DeviceMaps device_maps() {
    return call_([&] { return pipeline_.device_maps(); });
  }

  py::dict options() const { return option_values(pipeline_.options()); }
  std::string engine_name() {  // which `set_mask` may change
    return call_([&] { return pipeline_.engine_name(); });
  }
  const std::optional<StereoCalibration>& calibration() const { return pipeline_.calibration(); }

 private:
  SerialCalls call_;
  Pipeline pipeline_;
};

std::unique_ptr<SharedPipeline> make_pipeline(const std::string& preset_name, const py::object& calibration,
                                              const py::object& options, const py::kwargs& keywords) {
  PipelineOptions all = preset(preset_name);
  set_options(all, options, keywords);
  const std::optional<StereoCalibration> known = optional_calibration(calibration);
  const py::gil_scoped_release release;
  return std::make_unique<SharedPipeline>(all, known);
}

constexpr const char* pipeline_doc =
    R"(Computes disparity, roll and transformed disparity of successive stereo pairs.

The road is tracked from pair to pair. Several threads may use one pipeline, one after the other; pipelines of different
threads run in parallel, without the interpreter's lock.)";

constexpr const char* pipeline_init_doc =
    R"(Make a pipeline.

preset is "default", "fast" or "paper". Without a calibration nothing is metric. Options have the keys of the command
line's --set: Pipeline(threads=2, options={"matcher.block_radius": 3}). Raises Error for an unknown option, naming the
nearest, and for a value out of range.)";

constexpr const char* process_doc =
    R"(Process one rectified pair.

left and right are arrays (H, W), or (H, W, 3 or 4) in colour, of uint8 or uint16, from 32×32 to 8192×8192 pixels. They
are not copied: rows may be any number of bytes apart or in reverse order (slices of rows, the halves of an image with
both views), but the pixels of a row must be adjacent. order is that of the channels, "bgr" (OpenCV) or "rgb".

Raises Error for an invalid pair: sizes differ, an image has one colour, both images are the same, left and right seem
to be swapped, or the calibration or the mask belongs to another size. Raises TypeError for another sample type.)";

}  // namespace

void bind_pipeline(py::module_& module) {
  module.def("preset_names", &preset_names, "Return the names of the presets.");
  module.def(
      "describe_options",
      [] {
        py::dict descriptions;
        for (const OptionText& option : list_options(preset("default"))) {
          descriptions[py::str(option.key)] = option.description;
        }
        return descriptions;
      },
      "Return what each option does, by its key, with its unit.");
  py::class_<SharedPipeline>(module, "Pipeline", pipeline_doc)
      .def(py::init(&make_pipeline), py::arg("preset") = "default", py::arg("calibration") = py::none(),
           py::arg("options") = py::none(), pipeline_init_doc)
      .def("process", &SharedPipeline::process, py::arg("left"), py::arg("right"), py::arg("order") = "bgr",
           process_doc)
      .def("set_mask", &SharedPipeline::set_mask, py::arg("mask"),
           "Leave out pixels of the left image where the mask, (H, W) bool or uint8, is not 0, in all later pairs.\n\n"
           "They have neither disparity nor damage. None ends it. The engine auto becomes cpu; raises Error with cuda.")
      .def("warm_up", &SharedPipeline::warm_up, py::arg("width"), py::arg("height"),
           "Allocate memory and start threads for pairs of this size, pixels. Resets the pipeline.")
      .def("set_device_options", &SharedPipeline::set_device_options, py::kw_only(), py::arg("download") = true,
           "Engine cuda: leave the maps of later pairs on the GPU (download=False).\n\n"
           "The arrays of their results are then empty; only `device_maps` has the maps. Raises Error for any other "
           "engine.")
      .def("device_maps", &SharedPipeline::device_maps,
           "Engine cuda: return the maps of the last pair in the memory of the GPU.\n\n"
           "Raises Error for any other engine, or without a pair.")
      .def("reset", &SharedPipeline::reset, "Make the next pair start without the road of the last one.")
      .def_property_readonly("options", &SharedPipeline::options, "Every option by its key.")
      .def_property_readonly("engine_name", &SharedPipeline::engine_name, "Matching engine in use.")
      .def_property_readonly("calibration", &SharedPipeline::calibration, "Calibration of the pairs, or None.");
}

}  // namespace roadstereo::python

#include "roadstereo/io/frame_source.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "calibration.hpp"
#include "frame_array.hpp"
#include "record.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_frame.hpp"
#include "serial_calls.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

/// A pair of a source, as arrays.
struct PairArrays {
  std::int64_t index = 0;
  std::string name;
  double time_s = 0;
  py::object left;
  py::object right;
  std::string error;
};

/// A source that any thread may read; readers wait for each other, without the interpreter's lock.
class SharedSource {
 public:
  explicit SharedSource(std::unique_ptr<io::FrameSource> source) : source_(std::move(source)) {}

  PairArrays next() {
    std::optional<io::SourcePair> pair = call_([&] { return source_->next(); });
    if (!pair) throw py::stop_iteration();
    PairArrays arrays{pair->index, io::valid_utf8(pair->name), pair->time_s, {}, {}, io::valid_utf8(pair->error)};
    if (arrays.error.empty()) {
      arrays.left = frame_array(std::move(pair->left));
      arrays.right = frame_array(std::move(pair->right));
    }
    return arrays;
  }
  void skip(std::int64_t pairs) {
    call_([&] { source_->skip(pairs); });
  }
  std::optional<std::int64_t> size() {
    return call_([&] { return source_->size(); });
  }
  std::string description() {
    return io::valid_utf8(call_([&] { return source_->description(); }));
  }
  py::object calibration() {
    const auto file = call_([&] { return source_->calibration(); });
    return file ? calibration_object(*file, description()) : py::none();
  }
  bool live() const { return source_->live(); }

 private:
  SerialCalls call_;
  std::unique_ptr<io::FrameSource> source_;
};

std::unique_ptr<SharedSource> open(const std::filesystem::path& source,
                                   const std::optional<std::filesystem::path>& right, const std::string& layout,
                                   const std::vector<std::string>& topics, double max_time_difference_s,
                                   std::pair<int, int> camera_size, double rate_hz) {
  std::vector<std::string> names{source.string()};
  if (right) names.push_back(right->string());
  const io::SourceOptions options{io::stereo_layout(layout), topics, max_time_difference_s, camera_size.first,
                                  camera_size.second,        rate_hz};
  options.validate();
  const py::gil_scoped_release release;
  return std::make_unique<SharedSource>(io::open_source(names, options));
}

/// Throws the reason of a pair without frames.
template <auto Frame>
py::object frame_of(const PairArrays& pair) {
  if (!pair.error.empty()) fail(pair.error);
  return pair.*Frame;
}

constexpr const char* open_doc =
    R"(Open a recording or a camera, an iterator of SourcePair.

source is a folder (left/ right/ and others), a list of pairs, a video with both views, a bag of ROS 1 or ROS 2
(.bag, .db3, .mcap), a V4L2 camera (/dev/video0) or a GStreamer pipeline; or source and right are two folders or two
videos. layout is "auto", "side-by-side" or "top-bottom"; topics are the left and right image topic of a bag; rate_hz,
pairs per second, replaces the times of a recording. Raises Error if it is none of these or cannot be opened.)";

}  // namespace

void bind_frame_source(py::module_& module) {
  const auto pair =
      py::class_<PairArrays>(module, "SourcePair", "One unrectified pair of a source, or the reason why it is missing.")
          .def_readonly("index", &PairArrays::index, "In the source, from 0.")
          .def_readonly("name", &PairArrays::name, "File name, or the index in six digits.")
          .def_readonly("time_s", &PairArrays::time_s,
                        "Seconds since 1970 if known, else since the start of the source; NaN: unknown.")
          .def_property_readonly(
              "left", frame_of<&PairArrays::left>,
              "(H, W), or (H, W, 3 or 4) in the order BGR; uint8 or uint16. Raises Error if `error`.")
          .def_property_readonly("right", frame_of<&PairArrays::right>, "Like `left`.")
          .def_readonly("error", &PairArrays::error,
                        "Why the pair is invalid, e.g. unreadable or unpaired; empty: valid.");
  set_repr(pair, [](const PairArrays& one) {
    return "SourcePair(" + std::to_string(one.index) + ", '" + one.name + "'" +
           (one.error.empty() ? "" : ", " + one.error) + ")";
  });
  py::class_<SharedSource>(module, "FrameSource", "A recording or a camera: an iterator of SourcePair.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &SharedSource::next)
      .def("skip", &SharedSource::skip, py::arg("pairs"), "Skip pairs, without decoding them if the format allows it.")
      .def_property_readonly("size", &SharedSource::size,
                             "Number of pairs; of videos and bags an estimate. None: unknown.")
      .def_property_readonly("live", &SharedSource::live, "Whether the source is a camera.")
      .def_property_readonly("calibration", &SharedSource::calibration,
                             "Calibration or StereoRig contained in the source, or None.")
      .def_property_readonly("description", &SharedSource::description, "Short description.");
  module.def("open_source", &open, py::arg("source"), py::arg("right") = py::none(), py::kw_only(),
             py::arg("layout") = "auto", py::arg("topics") = std::vector<std::string>{},
             py::arg("max_time_difference_s") = 0.005, py::arg("camera_size") = std::pair(2560, 720),
             py::arg("rate_hz") = 0.0, open_doc);
}

}  // namespace roadstereo::python

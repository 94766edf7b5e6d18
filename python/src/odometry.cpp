#include "roadstereo/odometry.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "map_array.hpp"
#include "processed_frame.hpp"
#include "record.hpp"
#include "roadstereo/error.hpp"
#include "serial_calls.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

/// An odometry that any thread may use; calls wait for each other, without the interpreter's lock.
class SharedOdometry {
 public:
  SharedOdometry(const StereoCalibration& calibration, const OdometryOptions& options)
      : calibration_(calibration), odometry_(calibration, options) {}

  FramePose add(int frame, const ProcessedFrame& processed, double time_s) {
    require_maps(processed, "odometry: the maps of frame " + std::to_string(frame));
    const Image<float>& disparity = processed.result.disparity;
    calibration_.validate(disparity.width(), disparity.height(), "calibration");
    return call_([&] { return odometry_.add(frame, processed.result, time_s); });
  }
  int reference() {
    return call_([&] { return odometry_.reference(); });
  }
  std::vector<FrameLink> links() {
    return call_([&] { return odometry_.links(); });
  }
  std::vector<FramePose> trajectory() {
    return call_([&] { return odometry_.trajectory().frames; });
  }

 private:
  SerialCalls call_;
  StereoCalibration calibration_;
  Odometry odometry_;
};

void bind_poses(py::module_& module) {
  Record<FramePose>(module, "FramePose", "Pose of the left camera at one frame.")
      .field("frame", &FramePose::frame, "Index of the frame.")
      .field("piece", &FramePose::piece, "Piece of the trajectory; frames of different pieces are not linked.")
      .field(
          "camera_to_world", [](const FramePose& pose) { return matrix<3, 4>(pose.camera_to_world); },
          "(3, 4), metres; the world is the camera of the first frame of the piece.")
      .field(
          "covariance", [](const FramePose& pose) { return matrix<6, 6>(pose.covariance); },
          "(6, 6): translation (metres), then rotation vector (radians), in the axes of this camera.");
  Record<FrameLink>(module, "FrameLink", "Motion between the cameras of two frames.")
      .field("from_frame", &FrameLink::from, "Index of the earlier frame.")
      .field("to_frame", &FrameLink::to, "Index of the later frame.")
      .field(
          "status", [](const FrameLink& link) { return name_of(link.status); }, "'good' or 'weak'.")
      .field(
          "motion", [](const FrameLink& link) { return matrix<3, 4>(link.motion); },
          "(3, 4), metres: points of the earlier camera to the later one.")
      .field(
          "covariance", [](const FrameLink& link) { return matrix<6, 6>(link.covariance); },
          "(6, 6): translation, then rotation vector, in the axes of the later camera.")
      .field("correlation", &FrameLink::correlation, "Median NCC of patches of texture, −1 … 1.")
      .field("overlap", &FrameLink::overlap, "Share of the earlier view that the later one sees, 0 … 1.")
      .field("offset_px", &FrameLink::offset_px, "Disparity offset at infinity that was undone, pixels.")
      .field("offset_sd_px", &FrameLink::offset_sd_px, "Its standard error, pixels.")
      .field("measured_offset_px", &FrameLink::measured_offset_px, "What this link alone tells of it, pixels.")
      .field("measured_offset_sd_px", &FrameLink::measured_offset_sd_px, "Its standard error, pixels; 0: nothing.");
}

std::unique_ptr<SharedOdometry> make_odometry(const StereoCalibration& calibration, double min_correlation,
                                              double weak_correlation, double min_overlap, double reference_overlap,
                                              bool estimate_offset, int threads) {
  const OdometryOptions options{.min_correlation = min_correlation,
                                .weak_correlation = weak_correlation,
                                .min_overlap = min_overlap,
                                .reference_overlap = reference_overlap,
                                .estimate_offset = estimate_offset,
                                .threads = threads};
  return std::make_unique<SharedOdometry>(calibration, options);
}

constexpr const char* odometry_doc =
    R"(Estimates the motion of a rig from frame to frame.

A frame that cannot be linked starts a new piece. Several threads may use one, one after the other.)";

constexpr const char* odometry_init_doc =
    R"(Make an odometry.

min_correlation: below it there is no link; weak_correlation: below it a link is weak; min_overlap: share of the view that
a link needs; reference_overlap: below it the frame becomes the reference of the next ones; all 0 … 1. estimate_offset:
estimate and undo an offset of the disparities at infinity. threads: worker threads, 0: all cores.)";

}  // namespace

void bind_odometry(py::module_& module) {
  bind_poses(module);
  const OdometryOptions usual;
  py::class_<SharedOdometry>(module, "Odometry", odometry_doc)
      .def(py::init(&make_odometry), py::arg("calibration"), py::kw_only(),
           py::arg("min_correlation") = usual.min_correlation, py::arg("weak_correlation") = usual.weak_correlation,
           py::arg("min_overlap") = usual.min_overlap, py::arg("reference_overlap") = usual.reference_overlap,
           py::arg("estimate_offset") = usual.estimate_offset, py::arg("threads") = usual.threads, odometry_init_doc)
      .def("add", &SharedOdometry::add, py::arg("frame"), py::arg("result"),
           py::arg("time_s") = std::numeric_limits<double>::quiet_NaN(),
           "Add the result of a frame, whose index is above that of the last one; return its pose.\n\n"
           "time_s, if known, tells of missing frames that indices do not count.\n\n"
           "Raises Error when sizes differ or the index does not grow.")
      .def_property_readonly("reference", &SharedOdometry::reference,
                             "Index of the frame that the next one is aligned with; −1 before the first.")
      .def_property_readonly("links", &SharedOdometry::links, "Links so far, one per frame that has one.")
      .def_property_readonly("trajectory", &SharedOdometry::trajectory, "Poses so far, one per frame.");
}

}  // namespace roadstereo::python

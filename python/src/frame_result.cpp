#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <numbers>
#include <optional>

#include "bindings.hpp"
#include "map_array.hpp"
#include "processed_frame.hpp"
#include "record.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

void bind_planes(py::module_& module) {
  Record<DisparityPlane> disparity(module, "DisparityPlane",
                                   "Plane in disparity space: d(u, v) = a0 + a1·v + a2·u, pixels.");
  disparity.field("a0", &DisparityPlane::a0, "Pixels.")
      .field("a1", &DisparityPlane::a1, "Pixels per row.")
      .field("a2", &DisparityPlane::a2, "Pixels per column.");
  disparity.type().def("disparity", py::vectorize(&DisparityPlane::disparity), py::arg("u"), py::arg("v"),
                       "Return the disparity at column u and row v, numbers or arrays, pixels.");
  Record<GroundPlane>(module, "GroundPlane", "Road plane in space, camera frame: normal · p = height_m.")
      .field("normal", &GroundPlane::normal, "Unit vector [x, y, z] from the camera towards the road.")
      .field("height_m", &GroundPlane::height_m, "Distance of the left camera from the plane, metres.")
      .field("pitch_rad", &GroundPlane::pitch_rad, "Angle of the optical axis below the road's horizon, radians.");
}

void bind_road_model(py::module_& module) {
  using Road = RoadModelEstimate;
  Record<Road>(module, "RoadModelEstimate", "Road model before matching.")
      .field("model", &Road::model, "Disparities of the road.")
      .field(
          "status", [](const Road& road) { return name_of(road.status); }, "'found', 'tracked', 'weak' or 'none'.")
      .field("reason", &Road::reason, "Why there is no road, or a weak one; else empty.")
      .field("evidence", &Road::evidence,
             "Evidence for the plane per pixel of its part of the picture, about 0 … 2; 0 when tracked.")
      .field("inlier_share", &Road::inlier_share, "Share of the textured samples that the plane explains, 0 … 1.")
      .field("correlation", &Road::correlation, "10th percentile of the NCC of blocks on the road; 0: unknown.")
      .field("matches", &Road::matches, "Reliable correspondences.")
      .field("inliers", &Road::inliers, "Correspondences on the road.")
      .field("residual_px", &Road::residual_px, "Robust standard deviation of the inliers, pixels.");
}

void bind_geometry(py::module_& module) {
  Record<RollEstimate>(module, "RollEstimate", "Roll angle and projection model of the road: d = alpha0 + alpha1·y(ψ).")
      .field("roll_rad", &RollEstimate::roll_rad, "Roll angle ψ, radians.")
      .field("roll_stderr_rad", &RollEstimate::roll_stderr_rad, "Its standard error, radians.")
      .field("roll_observable", &RollEstimate::roll_observable, "False when the camera looks straight down.")
      .field("alpha0", &RollEstimate::alpha0, "Pixels.")
      .field("alpha1", &RollEstimate::alpha1, "Pixels per pixel.")
      .field("plane", &RollEstimate::plane, "The same model as a plane.")
      .field("iterations", &RollEstimate::iterations, "Steps of the solver.")
      .field("pixels", &RollEstimate::pixels, "Disparities used.")
      .field("residual_px", &RollEstimate::residual_px,
             "Standard deviation of the disparities around the model, pixels.");
  Record<RowOffset>(module, "RowOffset", "A line of vertical offsets.")
      .field("constant_px", &RowOffset::constant_px, "At column 0 and row 0, pixels.")
      .field("per_column", &RowOffset::per_column, "Pixels per column of the right image.")
      .field("per_row", &RowOffset::per_row, "Pixels per row.");
  Record<Misalignment>(module, "Misalignment", "What the rectification left of a wrong pose of the right camera.")
      .field("rows_px", &Misalignment::rows_px, "How much lower its rows lie at the principal point, pixels.")
      .field("turn_rad", &Misalignment::turn_rad, "Turn about its optical axis, clockwise, radians.")
      .field("row_scale", &Misalignment::row_scale, "Relative difference of the scale of its rows.");
  Record<PerspectiveShift>(module, "PerspectiveShift", "Shift of the perspective transformation.")
      .field("road", &PerspectiveShift::road, "Disparities of the road.")
      .field("delta_p", &PerspectiveShift::delta_p, "Disparity of the road after the shift, pixels.")
      .field("disparities", &PerspectiveShift::disparities, "Number of disparities searched after the shift.")
      .field("enabled", &PerspectiveShift::enabled, "False: nothing was shifted.")
      .field("misalignment", &PerspectiveShift::misalignment, "That of the right image, which was undone.");
  Record<RoadResiduals>(module, "RoadResiduals", "Standard deviations of the transformed disparities, eq. (37).")
      .field("sigma_road_px", &RoadResiduals::sigma_road_px, "σ_d of the road, pixels.")
      .field("sigma_all_px", &RoadResiduals::sigma_all_px, "σ_d of all valid pixels, pixels.")
      .field("road_share", &RoadResiduals::road_share, "Share of the valid pixels that count as road, 0 … 1.");
  Record<BlurDifference>(module, "BlurDifference", "How much more the right image is blurred than the left one.")
      .field("variance_px2", &BlurDifference::variance_px2, "Difference of the variances of two Gaussians, pixels².")
      .field("stderr_px2", &BlurDifference::stderr_px2, "Its standard error, pixels².")
      .field("windows", &BlurDifference::windows, "Windows that were compared; 0: unknown.");
  Record<RowAlignment>(module, "RowAlignment", "Vertical offset of the matched points of a pair.")
      .field("median_px", &RowAlignment::median_px, "Median of right minus left row, pixels.")
      .field("sigma_px", &RowAlignment::sigma_px, "Robust standard deviation, pixels.")
      .field("points", &RowAlignment::points, "Matched points; with fewer than 20 the offset is unknown.")
      .field("fit_sigma_px", &RowAlignment::fit_sigma_px, "Robust standard deviation around the fit, pixels.")
      .field("fit", &RowAlignment::fit, "Robust fit; without slopes where none is significant.");
}

void bind_times(py::module_& module) {
  Record<StageTimes>(module, "StageTimes", "Times of the stages of one frame, milliseconds.")
      .field("prepare", &StageTimes::prepare, "Conversion to grey, checks of the pair.")
      .field("road_model", &StageTimes::road_model, "Road model before matching.")
      .field("perspective", &StageTimes::perspective, "Perspective transformation.")
      .field("coarse", &StageTimes::coarse, "Coarse search.")
      .field("match", &StageTimes::match, "Matching.")
      .field("refinement", &StageTimes::refinement, "Refinement.")
      .field("roll", &StageTimes::roll, "Roll and projection model.")
      .field("transform", &StageTimes::transform, "Disparity transformation.")
      .field("download", &StageTimes::download, "Maps from a device to the host.")
      .field("total", &StageTimes::total, "All of them.");
}

/// A property that is an array of a map.
template <auto Map>
py::object frame_map(const py::object& self) {
  return map_array(self.cast<const ProcessedFrame&>().result.*Map, self);
}

template <auto Member>
auto value_of(const ProcessedFrame& frame) {
  return frame.result.*Member;
}

template <auto Angle>
double degrees_of(const ProcessedFrame& frame) {
  if (!frame.result.roll_found) return std::numeric_limits<double>::quiet_NaN();
  return frame.result.geometry.*Angle * 180 / std::numbers::pi;
}

std::optional<GroundPlane> plane_of(const ProcessedFrame& frame) {
  if (!frame.calibration || !frame.result.roll_found) return std::nullopt;
  return ground_plane(frame.result.geometry.plane, *frame.calibration);
}

void add_maps(py::class_<ProcessedFrame>& type) {
  type.def_property_readonly("disparity", frame_map<&FrameResult::disparity>,
                             "Disparities of the left image, (H, W) float32, pixels; NaN invalid.");
  type.def_property_readonly("sigma", frame_map<&FrameResult::sigma>,
                             "Standard errors of `disparity`, (H, W) float32, pixels; NaN where it is invalid.");
  type.def_property_readonly(
      "transformed", frame_map<&FrameResult::transformed>,
      "Transformed disparities, (H, W) float32, pixels: the intact road lies at `delta_t`, damage\n"
      "below, bumps above; NaN invalid.");
  type.def_property_readonly("grey", frame_map<&FrameResult::grey>,
                             "The left image, (H, W) int16, sixteenths of a grey level, 0 … 4080.");
  type.def_property_readonly(
      "mask",
      [](const py::object& self) -> py::object {
        if (self.cast<const ProcessedFrame&>().result.mask.empty()) return py::none();
        return frame_map<&FrameResult::mask>(self);
      },
      "Mask of the pipeline, (H, W) uint8, not 0 where pixels are left out; None without one.");
}

void add_values(py::class_<ProcessedFrame>& type) {
  type.def_property_readonly("roll_deg", degrees_of<&RollEstimate::roll_rad>,
                             "Roll angle ψ, degrees; NaN if it was not found.");
  type.def_property_readonly("roll_stderr_deg", degrees_of<&RollEstimate::roll_stderr_rad>,
                             "Standard error of `roll_deg`, degrees; NaN if the roll was not found.");
  type.def_property_readonly(
      "geometry",
      [](const ProcessedFrame& frame) {
        return frame.result.roll_found ? std::optional(frame.result.geometry) : std::nullopt;
      },
      "Roll and projection model of the road after matching; None if it was not found.");
  type.def_property_readonly("ground_plane", plane_of,
                             "The road in space; None without a calibration, or if the roll was not found.");
  type.def_property_readonly("delta_t", value_of<&FrameResult::delta_t>,
                             "Value of the intact road in `transformed`, pixels.");
  type.def_property_readonly("valid_share", value_of<&FrameResult::valid_share>,
                             "Share of the pixels that have a disparity, 0 … 1.");
  type.def_property_readonly("mde_per_s", value_of<&FrameResult::mde_per_s>,
                             "Millions of disparity evaluations per second.");
  type.def_property_readonly("road", value_of<&FrameResult::road>, "Road model before matching, with its status.");
  type.def_property_readonly("shift", value_of<&FrameResult::shift>, "Shift of the perspective transformation.");
  type.def_property_readonly("spread", value_of<&FrameResult::spread>, "Standard deviations of `transformed`.");
  type.def_property_readonly("rows", value_of<&FrameResult::rows>, "Vertical offset of the pair.");
  type.def_property_readonly("blur", value_of<&FrameResult::blur>, "Difference of the blur of the pair.");
  type.def_property_readonly("smoothed_px2", value_of<&FrameResult::smoothed_px2>,
                             "Variance of the Gaussian with which the left image was smoothed, or, if negative, the "
                             "right one, pixels².");
  type.def_property_readonly("ms", value_of<&FrameResult::ms>, "Times of the stages, milliseconds.");
  type.def_property_readonly("warnings", value_of<&FrameResult::warnings>,
                             "What is wrong with the pair, as sentences.");
  type.def_readonly("calibration", &ProcessedFrame::calibration, "Calibration of the pipeline, or None.");
  set_repr(type, [](const ProcessedFrame& frame) {
    const FrameResult& result = frame.result;
    return "FrameResult(" + std::to_string(result.disparity.width()) + "×" + std::to_string(result.disparity.height()) +
           " pixels, road " + name_of(result.road.status) + ")";
  });
}

}  // namespace

void bind_frame_result(py::module_& module) {
  bind_planes(module);
  bind_road_model(module);
  bind_geometry(module);
  bind_times(module);
  py::class_<ProcessedFrame> type(module, "FrameResult",
                                  "Result for one pair.\n\n"
                                  "Its arrays are read-only views, which keep its memory alive. The next pair does not "
                                  "change them.");
  add_maps(type);
  add_values(type);
}

}  // namespace roadstereo::python

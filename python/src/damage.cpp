#include "roadstereo/damage.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings.hpp"
#include "map_array.hpp"
#include "option_values.hpp"
#include "processed_frame.hpp"
#include "record.hpp"
#include "roadstereo/health.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

void bind_measurements(py::module_& module) {
  Record<Measurement>(module, "Measurement", "A measured value with its standard error.")
      .field("value", &Measurement::value, "Value.")
      .field("std_error", &Measurement::std_error, "Standard error, in the unit of the value.");
  Record<SeverityProbabilities>(module, "SeverityProbabilities",
                                "Probability of each class of the severity scheme, ASTM D6433 by default, 0 … 1.")
      .field("minor", &SeverityProbabilities::minor, "Below the table.")
      .field("low", &SeverityProbabilities::low, "Low.")
      .field("medium", &SeverityProbabilities::medium, "Medium.")
      .field("high", &SeverityProbabilities::high, "High.");
}

void bind_metrics(py::module_& module) {
  using Metrics = DamageMetrics;
  Record<Metrics>(
      module, "DamageMetrics",
      "Metric properties of a damage. Depth is measured along the road's normal from the undamaged surface;\n"
      "it is positive for depressions and for protrusions.")
      .field("area_m2", &Metrics::area_m2, "Area on the road's surface.")
      .field("max_depth_m", &Metrics::max_depth_m, "Maximum depth, or height of a protrusion.")
      .field("mean_depth_m", &Metrics::mean_depth_m, "Mean over the region, interpolated holes included.")
      .field("volume_m3", &Metrics::volume_m3, "Volume.")
      .field("length_m", &Metrics::length_m, "Longer side of the minimum-area rectangle on the road.")
      .field("width_m", &Metrics::width_m, "Shorter side of that rectangle.")
      .field("angle_rad", &Metrics::angle_rad, "Direction of the longer side, −π/2 … π/2, from the road's x axis.")
      .field("diameter_m", &Metrics::diameter_m, "Diameter of the circle of equal area.")
      .field("wall_slope", &Metrics::wall_slope, "Mean slope of the wall, rise over run; a lower bound.")
      .field("outline_m", &Metrics::outline_m, "Outline [[x, y], …] on the road, counterclockwise, not closed.")
      .field(
          "distress", [](const Metrics& metrics) { return name_of(metrics.distress); },
          "'pothole', 'depression', 'rut', 'crack', 'bump', 'debris', 'kerb step' or 'unknown'.")
      .field("quantity", &Metrics::quantity, "Amount in `unit`, as the standard counts the distress.")
      .field(
          "unit", [](const Metrics& metrics) { return name_of(metrics.unit); }, "'count', 'm2' or 'm'.")
      .field("centroid_m", &Metrics::centroid_m, "[x, y, z] on the undamaged surface, camera frame.")
      .field("road_centroid_m", &Metrics::road_centroid_m,
             "[x, y] on the road: x to the camera's right, y forward from its foot.")
      .field("distance_m", &Metrics::distance_m, "From the left camera to the centroid.")
      .field("resolvable_depth_m", &Metrics::resolvable_depth_m, "Smallest resolvable depth here.")
      .field("severity_probabilities", &Metrics::severity_probabilities, "All 0 if the distress has no classes.")
      .field(
          "severity", [](const Metrics& metrics) { return name_of(metrics.severity); },
          "'minor', 'low', 'medium', 'high', 'uncertain', 'unresolvable' or 'unknown'.")
      .field("severity_range", &severity_text, "In words: 'medium', 'medium–high', 'not graded', 'unresolvable'.");
}

void bind_one_damage(py::module_& module) {
  using Evidence = DamageEvidence;
  Record<Evidence>(module, "DamageEvidence", "What distinguishes a damage from noise and from what is not road.")
      .field("contrast_sigmas", &Evidence::contrast_sigmas, "Median depth, standard deviations of the band around.")
      .field("significance", &Evidence::significance, "Contrast times the root of the number of samples.")
      .field("steepness", &Evidence::steepness, "Maximum mean slope on a contour, relative to a cone.")
      .field("road_share", &Evidence::road_share, "Share of the band around that is road, 0 … 1.")
      .field("border_share", &Evidence::border_share,
             "Share of the outline on the border of what both cameras see, 0 … 1.")
      .field("unseen_share", &Evidence::unseen_share,
             "Share of the outline on a gap of the map that reaches that border, 0 … 1.")
      .field("surface_significance", &Evidence::surface_significance,
             "Standard errors by which the images agree better along the measured surface than the road; NaN unknown.")
      .field("range_vote", &Evidence::range_vote,
             "Mean vote of the images for the measured disparities against those not searched, -1 … 1; NaN unknown.")
      .field("specular_excess", &Evidence::specular_excess,
             "RMS of the light that one image shows above the other and above the road around, in brightnesses of that "
             "road: glint on a wet road; NaN unknown.")
      .field("texture_share", &Evidence::texture_share,
             "Share of the image around a protrusion with its texture rather than the road's, less that of the road, "
             "-1 … 1; NaN unknown and for depressions.")
      .field("pixel_significance", &Evidence::pixel_significance,
             "Upper quartile of the depths of the pixels in their standard errors; NaN unknown.")
      .field("likely_wall_slope", &Evidence::likely_wall_slope,
             "Slope of the wall of a depression, rise over run: mean of the measured and the steepest possible, at "
             "most 1; NaN unknown.")
      .field("extent", &Evidence::extent, "Diameter of the circle of equal area over 1.5 m; NaN without a calibration.")
      .field("rut_significance", &Evidence::rut_significance,
             "Depth below a straightedge across the road of the rut that the region lies in, in standard errors, times "
             "the share of the region that does; 0 if it lies in none.")
      .field("clutter", &Evidence::clutter,
             "Expected number of other regions of the image that are noise: twice the smaller of the sums of "
             "1 - confidence over its other hollows and over its other protrusions.")
      .field("depth_significance", &Evidence::depth_significance,
             "Maximum depth, standard errors from noise alone; below 3 the depth is unresolvable.");
  Record<Damage>(module, "Damage", "One damage: a connected component of the left image.")
      .field("id", &Damage::id, "Value in `DamageMap.ids`.")
      .field(
          "kind", [](const Damage& damage) { return name_of(damage.kind); }, "'depression' or 'protrusion'.")
      .field("pixels", &Damage::pixels, "Size, pixels.")
      .field("measured_share", &Damage::measured_share, "Share of the pixels with a disparity, 0 … 1.")
      .field("centroid_px", &Damage::centroid_px, "[u, v], pixels.")
      .field("box_px", &Damage::box_px, "Bounding box [u0, v0, u1, v1], pixels, both ends inclusive.")
      .field("deepest_px", &Damage::deepest_px, "[u, v] of the maximum depth, pixels.")
      .field("max_depth_px", &Damage::max_depth_px, "Maximum depth in `FrameResult.transformed`, pixels.")
      .field("mean_depth_px", &Damage::mean_depth_px, "Mean depth over the pixels with a disparity, pixels.")
      .field("confidence", &Damage::confidence, "Probability that this is damage, 0 … 1.")
      .field("evidence", &Damage::evidence, "What the confidence rests on.")
      .field("cut_by_border", &Damage::cut_by_border,
             "Whether it touches the border of what both cameras see, or a mask.")
      .field("ends_search", &Damage::ends_search,
             "Whether its floor lies where the searched disparities end: it may be deeper.")
      .field("metrics", &Damage::metrics, "Metric properties; None without a calibration.");
}

template <auto Map>
py::object damage_map(const py::object& self) {
  return map_array(self.cast<const DamageMap&>().*Map, self);
}

void bind_damage_map(py::module_& module) {
  const auto type =
      py::class_<DamageMap>(module, "DamageMap",
                            "Damage of one pair. Its arrays are read-only views, which keep its memory alive.")
          .def_readonly("damages", &DamageMap::damages, "List of damages, deepest first.")
          .def_readonly("candidates", &DamageMap::candidates,
                        "List of unresolvable regions and of those below damage.min_confidence; not in `ids`.")
          .def_property_readonly("ids", damage_map<&DamageMap::ids>, "Id of the damage, (H, W) uint16; 0: none.")
          .def_property_readonly("road", damage_map<&DamageMap::road>,
                                 "255 in the road region, damage included; (H, W) uint8.")
          .def_property_readonly("surface", damage_map<&DamageMap::surface>,
                                 "Transformed disparities of the undamaged road, (H, W) float32, pixels.")
          .def_property_readonly(
              "depth", damage_map<&DamageMap::depth>,
              "Depth below the undamaged road, negative above it, (H, W) float32: metres if `metric`,\n"
              "else pixels. NaN in holes outside of damages, and where the right camera does not see the road.")
          .def_readonly("noise_px", &DamageMap::noise_px,
                        "Robust standard deviation of the intact road, pixels; NaN without\na road.")
          .def_readonly("metric", &DamageMap::metric, "Whether `depth` is in metres.")
          .def_readonly("non_metric_reason", &DamageMap::non_metric_reason,
                        "Why `metric` is False; empty if it is True.");
  set_repr(type, [](const DamageMap& map) {
    return "DamageMap(" + std::to_string(map.damages.size()) + " damages, " + std::to_string(map.candidates.size()) +
           " candidates)";
  });
}

std::unique_ptr<DamageMap> find_damage_of(const ProcessedFrame& frame, const py::object& options,
                                          const py::kwargs& keywords) {
  PipelineOptions all = frame.options;
  set_damage_options(all, options, keywords, true);
  auto map = std::make_unique<DamageMap>();
  const py::gil_scoped_release release;
  all.validate();
  find_damage(frame.result, frame.calibration, all.damage, all.threads, *map);
  withhold_severity(measure_health(frame.result, *map, frame.calibration, all.damage, all.threads), *map);
  return map;
}

}  // namespace

void bind_damage(py::module_& module) {
  bind_measurements(module);
  bind_metrics(module);
  bind_one_damage(module);
  bind_damage_map(module);
  module.def(
      "find_damage", &find_damage_of, py::arg("result"), py::arg("options") = py::none(),
      "Find and measure the regions that differ from the road's surface; none without a road. Where the images show\n"
      "that depths cannot be trusted, such as rows that disagree, severities are unknown.\n\n"
      "The options are those of the pipeline, unless others are given: options={\"damage.min_confidence\": 0.3}.\n"
      "Raises Error when hardly any disparity lies on a road, and for bad options.");
}

}  // namespace roadstereo::python

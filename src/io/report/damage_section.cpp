#include "io/report/damage_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/pictures.hpp"
#include "io/report/profile.hpp"
#include "io/report/relief_view.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/cross_section.hpp"

namespace roadstereo::io {
namespace {

using Properties = std::vector<std::pair<std::string, std::string>>;

constexpr double mm = 1000;      // in a metre
constexpr double litres = 1000;  // in a cubic metre

std::string pair_text(double first, double second, int decimals, const std::string& unit) {
  return "(" + number_text(first, decimals) + ", " + number_text(second, decimals) + ")\u00a0" + unit;
}

std::string quantity_text(const DamageMetrics& metrics) {
  if (metrics.unit == DistressUnit::square_metre) return value_text(metrics.quantity, "m²");
  if (metrics.unit == DistressUnit::metre) return value_text(metrics.quantity, "m");
  return number_text(metrics.quantity, metrics.quantity == 1 ? 0 : 1);
}

std::string probabilities_text(const SeverityProbabilities& p) {
  constexpr double percent = 100;
  return number_text(percent * p.minor, 0) + "\u00a0/\u00a0" + number_text(percent * p.low, 0) + "\u00a0/\u00a0" +
         number_text(percent * p.medium, 0) + "\u00a0/\u00a0" + number_text(percent * p.high, 0) + "\u00a0%";
}

Properties metric_properties(const Damage& damage, const DamageMetrics& metrics, bool in_recording) {
  const bool cut = damage.cut_by_border;
  const std::string in_frame = in_recording && cut ? " in this frame" : "";
  const bool rises = damage.kind == DamageKind::protrusion;
  Properties properties{
      {rises ? "maximum height" : "maximum depth", measured_text(scaled(metrics.max_depth_m, mm), "mm")},
      {rises ? "mean height" : "mean depth", measured_text(scaled(metrics.mean_depth_m, mm), "mm")},
      {"area" + in_frame, bound_text(cut, measured_text(metrics.area_m2, "m²"))},
      {"volume" + in_frame, bound_text(cut, measured_text(scaled(metrics.volume_m3, litres), "L"))},
      {"length × width" + in_frame,
       bound_text(cut, value_text(metrics.length_m, "") + " × " + value_text(metrics.width_m, "m"))},
      {"mean diameter" + in_frame, bound_text(cut, value_text(metrics.diameter_m, "m"))},
      {"quantity" + in_frame, bound_text(cut, quantity_text(metrics))}};
  const SeverityProbabilities& p = metrics.severity_probabilities;
  if (p.minor + p.low + p.medium + p.high > 0) {
    properties.emplace_back("minor / low / medium / high", probabilities_text(p));
  }
  properties.emplace_back("confidence", number_text(100 * damage.confidence, 0) + "\u00a0%");
  properties.emplace_back("in front of the camera (x, y)",
                          pair_text(metrics.road_centroid_m[0], metrics.road_centroid_m[1], 2, "m"));
  properties.emplace_back("resolvable depth", value_text(metrics.resolvable_depth_m * mm, "mm"));
  return properties;
}

Properties properties_of(const Damage& damage, bool in_recording) {
  if (damage.metrics) return metric_properties(damage, *damage.metrics, in_recording);
  return {{"maximum disparity change", measured_text(damage.max_depth_px, "px")},
          {"centre (u, v)", pair_text(damage.centroid_px[0], damage.centroid_px[1], 0, "px")},
          {"size", std::to_string(damage.pixels) + "\u00a0px"},
          {"measured", number_text(100 * damage.measured_share, 0) + "\u00a0%"},
          {"confidence", number_text(100 * damage.confidence, 0) + "\u00a0%"}};
}

std::string properties_html(const Properties& properties) {
  std::string html;
  for (const auto& [name, value] : properties) {
    html += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>";
  }
  return html;
}

/// Maximum absolute depth of the region: end of the colour scale.
double max_depth_of(const DamageMap& map, const Damage& damage) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  double max_depth = 1e-6;
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      const double depth = std::abs(static_cast<double>(map.depth(u, v)));
      if (map.ids(u, v) == damage.id && std::isfinite(depth)) max_depth = std::max(max_depth, depth);
    }
  }
  return max_depth;
}

/// Numbers beside the colour scale, −max_depth at the top.
std::string scale_html(double max_depth) {
  constexpr int max_ticks = 7;
  const Ticks ticks = round_ticks(-max_depth, max_depth, max_ticks);
  std::string html;
  for (const double value : ticks.values) {
    html += "<span style=\"top:" + number_text(50 * (value + max_depth) / max_depth, 1) + "%\">" +
            number_text(value, ticks.decimals) + "</span>";
  }
  return html;
}

std::string note_of(const Damage& damage) {
  std::string note = damage.metrics ? distress_reason(*damage.metrics) : "";
  const auto add = [&](const char* text) { note += (note.empty() ? "" : "; ") + std::string(text); };
  if (damage.cut_by_border) add("cut by the border of the view: may be larger");
  if (damage.ends_search) add("the search for disparities ends at its floor: may be deeper");
  return note;
}

/// The map whose NaN pixels are the holes.
ImageView<const float> holes_of(const DamageReportInput& input) {
  return input.disparity.empty() ? input.transformed : input.disparity;
}

/// The calibration if there are disparities to triangulate.
std::optional<StereoCalibration> rig_of(const DamageReportInput& input) {
  return input.disparity.empty() ? std::nullopt : input.calibration;
}

}  // namespace

SectionSize SectionSize::for_count(std::size_t damages) {
  constexpr std::size_t few = 10, bytes_of_all = 900000;
  const std::size_t bytes = bytes_of_all / std::max<std::size_t>(1, damages);
  if (damages <= few) return {{480, bytes}, 120};
  return {{damages <= max_reliefs ? 360 : 160, bytes}, 72};
}

std::string damage_section(const DamageReportInput& input, const cv::Mat& background, const Damage& damage,
                           const SectionOptions& options) {
  const DamageMap& map = input.map;
  Crop crop = crop_around(map, damage, options.size.picture, input.calibration ? input.calibration->focal_px : 0);
  crop.id = options.id;
  const double max_depth = max_depth_of(map, damage);
  const CrossSection section = extract_cross_section(map, damage, holes_of(input), rig_of(input));
  Fields fields;
  fields["id"] = options.id;
  fields["kind"] = damage.metrics ? name_of(damage.metrics->distress) : name_of(damage.kind);
  fields["severity"] = name_of(severity_of(damage));
  fields["severity_text"] = damage.metrics ? severity_text(*damage.metrics) : "";
  fields["where"] = options.where;
  fields["note"] = note_of(damage);
  fields["properties"] = properties_html(properties_of(damage, options.in_recording));
  fields["crop"] = crop_svg(background, map, damage, crop);
  fields["depth"] = depth_svg(map, damage, crop, {holes_of(input), &section, max_depth});
  fields["depth_unit"] = map.metric ? "mm" : "px";
  fields["scale"] = scale_html(map.metric ? max_depth * mm : max_depth);
  fields["profile"] = profile_svg(section, damage, options.id, map.metric);
  fields["relief"] = "";
  if (options.with_relief) {
    const Relief relief = extract_relief(map, damage, holes_of(input), rig_of(input), options.size.relief_points);
    fields["relief"] = relief_html(relief, options.id, max_depth);
  }
  return fill(templates::damage, fields);
}

}  // namespace roadstereo::io

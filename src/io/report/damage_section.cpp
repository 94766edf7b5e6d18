#include "io/report/damage_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
constexpr double degrees = 180 / std::numbers::pi;

std::string pair_text(double first, double second, int decimals, const std::string& unit) {
  return "(" + number_text(first, decimals) + ", " + number_text(second, decimals) + ")\u00a0" + unit;
}

Properties metric_properties(const Damage& damage, const DamageMetrics& metrics) {
  const bool rises = damage.kind == DamageKind::protrusion;
  return {{rises ? "maximum height" : "maximum depth", measured_text(scaled(metrics.max_depth_m, mm), "mm")},
          {rises ? "mean height" : "mean depth", measured_text(scaled(metrics.mean_depth_m, mm), "mm")},
          {"area", measured_text(metrics.area_m2, "m²")},
          {"volume", measured_text(scaled(metrics.volume_m3, litres), "L")},
          {"length × width", value_text(metrics.length_m, "") + " × " + value_text(metrics.width_m, "m")},
          {"orientation", number_text(metrics.angle_rad * degrees, 0) + "°"},
          {"mean diameter", value_text(metrics.diameter_m, "m")},
          {"road position (x, y)", pair_text(metrics.road_centroid_m[0], metrics.road_centroid_m[1], 2, "m")},
          {"distance", value_text(metrics.distance_m, "m")},
          {"resolvable depth", value_text(metrics.resolvable_depth_m * mm, "mm")}};
}

Properties properties_of(const Damage& damage) {
  Properties properties;
  if (damage.metrics) properties = metric_properties(damage, *damage.metrics);
  properties.emplace_back("maximum disparity change", measured_text(damage.max_depth_px, "px"));
  properties.emplace_back("centre (u, v)", pair_text(damage.centroid_px[0], damage.centroid_px[1], 0, "px"));
  properties.emplace_back("size", std::to_string(damage.pixels) + "\u00a0px");
  properties.emplace_back("measured", number_text(100 * damage.measured_share, 0) + "\u00a0%");
  return properties;
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
                           const SectionSize& size, bool with_relief) {
  const DamageMap& map = input.map;
  const Crop crop = crop_around(map, damage, size.picture);
  const double max_depth = max_depth_of(map, damage);
  const CrossSection section = extract_cross_section(map, damage, holes_of(input), rig_of(input));
  Fields fields;
  fields["id"] = std::to_string(damage.id);
  fields["kind"] = name_of(damage.kind);
  fields["severity"] = name_of(severity_of(damage));
  fields["note"] = damage.cut_by_border ? "cut by the image border: the true size may be larger" : "";
  fields["properties"] = properties_html(properties_of(damage));
  fields["crop"] = crop_svg(background, map, damage, crop);
  fields["depth"] = depth_svg(map, damage, crop, {holes_of(input), &section, max_depth});
  fields["depth_unit"] = map.metric ? "mm" : "px";
  fields["scale"] = scale_html(map.metric ? max_depth * mm : max_depth);
  fields["profile"] = profile_svg(section, damage, map.metric);
  fields["relief"] = "";
  if (with_relief) {
    const Relief relief = extract_relief(map, damage, holes_of(input), rig_of(input), size.relief_points);
    fields["relief"] = relief_html(relief, damage, max_depth);
  }
  return fill(templates::damage, fields);
}

}  // namespace roadstereo::io

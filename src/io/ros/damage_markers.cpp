#include <cmath>

#include "io/damage_colours.hpp"
#include "io/report/number_text.hpp"
#include "io/ros/cdr_writer.hpp"
#include "io/ros/header.hpp"
#include "io/ros/messages.hpp"

namespace roadstereo::io {
namespace {

/// visualization_msgs/Marker with the axes of its frame.
struct Marker {
  std::int32_t id = 0;
  std::int32_t type = 0;
  std::int32_t action = 0;
  std::array<double, 3> position{}, scale{};
  std::array<float, 4> colour{};              ///< red, green, blue, alpha, 0 … 1
  std::vector<std::array<double, 2>> points;  ///< z = 0
  std::string text;
};

// Of visualization_msgs/Marker.
constexpr std::int32_t line_strip = 4, text_facing_view = 9, delete_all = 3;

void add_marker(const RosHeader& header, const Marker& marker, CdrWriter& cdr) {
  add_header(header, cdr);
  cdr.text("damages").add(marker.id).add(marker.type).add(marker.action);
  cdr.add_each(marker.position).add_each(std::array{0., 0., 0., 1.});
  cdr.add_each(marker.scale).add_each(marker.colour);
  cdr.add(std::int32_t{0}).add(std::uint32_t{0}).add(false);  // stays until it is deleted, is not locked to its frame
  cdr.count(marker.points.size());
  for (const auto& [x, y] : marker.points) cdr.add(x).add(y).add(0.);
  cdr.count(0);                      // colours of the points
  cdr.text("");                      // texture: its name,
  add_header({}, cdr);               // and its image
  cdr.text("").count(0).count(0);    // format, data, coordinates
  cdr.text(marker.text).text("");    // no mesh: its name,
  cdr.text("").count(0).add(false);  // and its file
}

std::array<float, 4> colour_of(const Damage& damage) {
  const Rgb rgb = damage_colour(damage.kind, severity_of(damage));
  const auto share = [](int level) { return static_cast<float>(level) / 255; };
  return {share(rgb[0]), share(rgb[1]), share(rgb[2]), 1};
}

}  // namespace

RosMessage damage_markers(const RosHeader& header, std::span<const Damage> damages, double camera_height_m) {
  constexpr double letter_share = 0.05, line_share = 0.005, mm = 1000;
  std::vector<Marker> markers(1);
  markers[0].action = delete_all;
  for (const Damage& damage : damages) {
    if (!damage.metrics) continue;
    const DamageMetrics& metrics = *damage.metrics;
    Marker outline;
    outline.id = 2 * damage.id;
    outline.type = line_strip;
    outline.scale = {line_share * camera_height_m, 0, 0};
    outline.colour = colour_of(damage);
    outline.points = metrics.outline_m;
    if (!outline.points.empty()) outline.points.push_back(outline.points.front());
    Marker text;
    text.id = 2 * damage.id + 1;
    text.type = text_facing_view;
    text.position = {metrics.road_centroid_m[0], metrics.road_centroid_m[1], letter_share * camera_height_m};
    text.scale = {0, 0, letter_share * camera_height_m};
    text.colour = {1, 1, 1, 1};
    text.text = std::string(name_of(metrics.distress)) + " " + measured_text(scaled(metrics.max_depth_m, mm), "mm") +
                ", " + measured_text(metrics.area_m2, "m²");
    markers.push_back(std::move(outline));
    markers.push_back(std::move(text));
  }
  CdrWriter cdr;
  cdr.count(markers.size());
  for (const Marker& marker : markers) add_marker(header, marker, cdr);
  return cdr.take();
}

}  // namespace roadstereo::io

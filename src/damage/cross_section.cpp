#include "roadstereo/cross_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "damage/local_ground_plane.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Line of the section in the image: through + t·direction, for the integers t from `first` to `last`.
struct Line {
  std::array<int, 2> through{};
  std::array<double, 2> direction{};  ///< the component of larger magnitude is ±1: one pixel per step
  int first = 0, last = 0;

  std::array<int, 2> at(int t) const {
    return {through[0] + static_cast<int>(std::lround(t * direction[0])),
            through[1] + static_cast<int>(std::lround(t * direction[1]))};
  }
};

/// Major axis of the region in the image, from its second moments.
std::array<double, 2> major_axis(const DamageMap& map, const Damage& damage) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  double uu = 0, uv = 0, vv = 0;
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      if (map.ids(u, v) != damage.id) continue;
      const double du = u - damage.centroid_px[0], dv = v - damage.centroid_px[1];
      uu += du * du;
      uv += du * dv;
      vv += dv * dv;
    }
  }
  const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
  return {std::cos(angle), std::sin(angle)};
}

bool is_inside(const DamageMap& map, const std::array<int, 2>& pixel) {
  return pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < map.ids.width() && pixel[1] < map.ids.height();
}

/// Last t in the region, in steps of `step` (1 or −1).
int last_in_region(const DamageMap& map, const Damage& damage, const Line& line, int step) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const int max_steps = std::max(u1 - u0, v1 - v0) + 1;
  int last = 0;
  for (int t = 0; std::abs(t) <= max_steps; t += step) {
    const std::array<int, 2> pixel = line.at(t);
    if (is_inside(map, pixel) && map.ids(pixel[0], pixel[1]) == damage.id) last = t;
  }
  return last;
}

/// Line through the deepest pixel, with a margin of road at both ends.
Line section_line(const DamageMap& map, const Damage& damage, const std::array<double, 2>& direction) {
  constexpr double margin_share = 0.2;
  constexpr int min_margin = 5;
  const double larger = std::max(std::abs(direction[0]), std::abs(direction[1]));
  Line line{damage.deepest_px, {direction[0] / larger, direction[1] / larger}, 0, 0};
  line.first = last_in_region(map, damage, line, -1);
  line.last = last_in_region(map, damage, line, 1);
  const int margin = std::max(min_margin, static_cast<int>(std::lround(margin_share * (line.last - line.first))));
  for (int i = 0; i < margin && is_inside(map, line.at(line.first - 1)); ++i) --line.first;
  for (int i = 0; i < margin && is_inside(map, line.at(line.last + 1)); ++i) ++line.last;
  return line;
}

std::vector<double> road_positions(const CrossSection& section, const LocalGroundPlane& road) {
  std::vector<double> positions;
  positions.reserve(section.pixel.size());
  const std::array<double, 2> origin = road.road_point(section.pixel.front()[0], section.pixel.front()[1]);
  for (const auto& [u, v] : section.pixel) {
    const std::array<double, 2> point = road.road_point(u, v);
    positions.push_back(std::hypot(point[0] - origin[0], point[1] - origin[1]));
  }
  return positions;
}

std::vector<double> pixel_positions(const CrossSection& section) {
  std::vector<double> positions;
  positions.reserve(section.pixel.size());
  const std::array<int, 2> origin = section.pixel.front();
  for (const auto& [u, v] : section.pixel) positions.push_back(std::hypot(u - origin[0], v - origin[1]));
  return positions;
}

}  // namespace

CrossSection extract_cross_section(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                                   const std::optional<StereoCalibration>& calibration) {
  require_same_size(map, disparity);
  const auto& [u, v] = damage.deepest_px;
  if (!is_inside(map, damage.deepest_px)) {
    fail("the deepest pixel of damage ", damage.id, " is (", u, ", ", v, "); it must lie inside the map of ",
         map.ids.width(), "×", map.ids.height(), " pixels");
  }
  const std::optional<LocalGroundPlane> road = fit_local_ground_plane(map, damage, disparity, calibration);
  const bool metric_axis = road && damage.metrics;
  const Line line = section_line(
      map, damage, metric_axis ? road->image_direction(u, v, damage.metrics->angle_rad) : major_axis(map, damage));

  CrossSection section;
  section.metric = road.has_value();
  for (int t = line.first; t <= line.last; ++t) {
    const std::array<int, 2> pixel = line.at(t);
    const double depth = map.depth(pixel[0], pixel[1]);
    const bool is_hole = !disparity.empty() && !std::isfinite(disparity(pixel[0], pixel[1]));
    section.pixel.push_back(pixel);
    section.filled.push_back(depth);
    section.depth.push_back(is_hole ? std::numeric_limits<double>::quiet_NaN() : depth);
  }
  section.position = road ? road_positions(section, *road) : pixel_positions(section);
  return section;
}

}  // namespace roadstereo

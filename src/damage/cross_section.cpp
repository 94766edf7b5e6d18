#include "roadstereo/cross_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "damage/local_road.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// The line of the image that is cut along: (u, v) + t·direction, t in whole steps from `first` to `last`.
struct Line {
  std::array<int, 2> through{};
  std::array<double, 2> direction{};  ///< its larger component is 1 or −1: one pixel per step
  int first = 0, last = 0;

  std::array<int, 2> at(int t) const {
    return {through[0] + static_cast<int>(std::lround(t * direction[0])),
            through[1] + static_cast<int>(std::lround(t * direction[1]))};
  }
};

/// The longer axis of the region in the image, from its second moments.
std::array<double, 2> long_axis(const DamageMap& map, const Damage& damage) {
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

bool inside(const DamageMap& map, const std::array<int, 2>& pixel) {
  return pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < map.ids.width() && pixel[1] < map.ids.height();
}

/// The last step that is inside the image and, without the margin, in the region.
int reach(const DamageMap& map, const Damage& damage, const Line& line, int step) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const int longest = std::max(u1 - u0, v1 - v0) + 1;
  int reached = 0;
  for (int t = 0; std::abs(t) <= longest; t += step) {
    const std::array<int, 2> pixel = line.at(t);
    if (inside(map, pixel) && map.ids(pixel[0], pixel[1]) == damage.id) reached = t;
  }
  return reached;
}

Line line_through(const DamageMap& map, const Damage& damage, const std::array<double, 2>& direction) {
  constexpr double margin_share = 0.2;
  constexpr int least_margin = 5;
  const double larger = std::max(std::abs(direction[0]), std::abs(direction[1]));
  Line line{damage.deepest_px, {direction[0] / larger, direction[1] / larger}, 0, 0};
  line.first = reach(map, damage, line, -1);
  line.last = reach(map, damage, line, 1);
  const int margin = std::max(least_margin, static_cast<int>(std::lround(margin_share * (line.last - line.first))));
  for (int i = 0; i < margin && inside(map, line.at(line.first - 1)); ++i) --line.first;
  for (int i = 0; i < margin && inside(map, line.at(line.last + 1)); ++i) ++line.last;
  return line;
}

std::vector<double> road_positions(const CrossSection& section, const LocalRoad& road) {
  std::vector<double> positions;
  positions.reserve(section.pixel.size());
  const std::array<double, 2> origin = road.at(section.pixel.front()[0], section.pixel.front()[1]);
  for (const auto& [u, v] : section.pixel) {
    const std::array<double, 2> at = road.at(u, v);
    positions.push_back(std::hypot(at[0] - origin[0], at[1] - origin[1]));
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

CrossSection cross_section(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                           const std::optional<StereoCalibration>& calibration) {
  require_same_size(map, disparity);
  const auto& [u, v] = damage.deepest_px;
  if (!inside(map, damage.deepest_px)) {
    fail("the deepest pixel of damage ", damage.id, " is (", u, ", ", v, "), outside the map of ", map.ids.width(), "×",
         map.ids.height(), " pixels");
  }
  const std::optional<LocalRoad> road = find_local_road(map, damage, disparity, calibration);
  const bool on_road = road && damage.metrics;
  const Line line = line_through(
      map, damage, on_road ? road->image_direction(u, v, damage.metrics->angle_rad) : long_axis(map, damage));

  CrossSection section;
  section.metric = road.has_value();
  for (int t = line.first; t <= line.last; ++t) {
    const std::array<int, 2> at = line.at(t);
    const double depth = map.depth(at[0], at[1]);
    const bool hole = !disparity.empty() && !std::isfinite(disparity(at[0], at[1]));
    section.pixel.push_back(at);
    section.filled.push_back(depth);
    section.depth.push_back(hole ? std::numeric_limits<double>::quiet_NaN() : depth);
  }
  section.position = road ? road_positions(section, *road) : pixel_positions(section);
  return section;
}

}  // namespace roadstereo

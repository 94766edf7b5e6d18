#include "io/flight/road_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/round_length.hpp"
#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/flight/templates.hpp"
#include "io/report/markup.hpp"

namespace roadstereo::io {
namespace {

constexpr double width = 720, min_height = 220, max_height = 620, margin = 46;  // of the drawing
constexpr double label_width = 26, label_height = 18;

/// Equirectangular projection around the middle of the positions. Longitudes are those within half a turn of the first.
class Projection {
 public:
  explicit Projection(const std::vector<std::array<double, 2>>& points_deg) : first_lon_deg_(points_deg.front()[0]) {
    std::array<double, 2> low = points_deg.front(), high = low;
    for (const auto& [lon_deg, lat_deg] : points_deg) {
      const std::array<double, 2> point{near_first(lon_deg), lat_deg};
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], point[k]);
        high[k] = std::max(high[k], point[k]);
      }
    }
    constexpr double earth_m = 6371008.8, degree = std::numbers::pi / 180;
    metres_ = {earth_m * degree * std::cos(0.5 * (low[1] + high[1]) * degree), earth_m * degree};
    const double across_m = std::max(1.0, (high[0] - low[0]) * metres_[0]);
    const double along_m = std::max(1.0, (high[1] - low[1]) * metres_[1]);
    scale_ = std::min((width - 2 * margin) / across_m, (max_height - 2 * margin) / along_m);
    height_ = std::max(min_height, along_m * scale_ + 2 * margin);
    middle_ = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};
  }

  std::array<double, 2> at(double lon_deg, double lat_deg) const {
    return {0.5 * width + (near_first(lon_deg) - middle_[0]) * metres_[0] * scale_,
            0.5 * height_ - (lat_deg - middle_[1]) * metres_[1] * scale_};
  }
  double height() const { return height_; }
  double pixels_per_metre() const { return scale_; }

 private:
  double near_first(double lon_deg) const {
    constexpr double turn_deg = 360;
    return first_lon_deg_ + std::remainder(lon_deg - first_lon_deg_, turn_deg);
  }

  double first_lon_deg_;
  std::array<double, 2> metres_{}, middle_{};
  double scale_ = 1, height_ = min_height;
};

std::string coordinate(double value) {
  return number_text(value, 1);
}

std::string path_of(const FlightReportInput& input, const Projection& map) {
  std::string path;
  bool down = false;
  for (const auto& [lon, lat] : input.track_deg) {
    const bool known = std::isfinite(lon) && std::isfinite(lat);
    if (known) {
      const auto [x, y] = map.at(lon, lat);
      path += (down ? "L" : "M") + coordinate(x) + " " + coordinate(y);
    }
    down = known;
  }
  return path;
}

/// Dots of the damages, worst on top; the worst have their numbers where these do not cover each other.
class Dots {
 public:
  explicit Dots(const Projection& map) : map_(map) {}

  void add(const RoadDamage& damage, bool has_row) {
    if (!damage.position) return;
    const auto [x, y] = map_.at(damage.position->lon_deg, damage.position->lat_deg);
    const auto [red, green, blue] = damage_colour(damage.best.kind, severity_of(damage.best));
    const std::string id = std::to_string(damage.id);
    std::string dot = "<circle r=\"6\" cx=\"" + coordinate(x) + "\" cy=\"" + coordinate(y) + "\" fill=\"rgb(" +
                      std::to_string(red) + "," + std::to_string(green) + "," + std::to_string(blue) + ")\"><title>" +
                      id + ": " + name_of(distress_of(damage.best)) + "</title></circle>";
    if (take_place(x + 9, y - label_height / 2)) {
      dot += "<text x=\"" + coordinate(x + 9) + "\" y=\"" + coordinate(y + 5) + "\">" + id + "</text>";
    }
    dots_.push_back(has_row ? damage_link(damage.id, dot) : dot);
  }
  std::string svg() const { return std::accumulate(dots_.rbegin(), dots_.rend(), std::string()); }

 private:
  bool take_place(double x, double y) {
    const bool taken = std::any_of(labels_.begin(), labels_.end(), [&](const std::array<double, 2>& other) {
      return std::abs(other[0] - x) < label_width && std::abs(other[1] - y) < label_height;
    });
    if (!taken) labels_.push_back({x, y});
    return !taken;
  }

  const Projection& map_;
  std::vector<std::array<double, 2>> labels_;
  std::vector<std::string> dots_;  ///< the worst first
};

std::string metres_text(double metres) {
  if (metres >= 1000) return number_text(metres / 1000, 0) + " km";
  return number_text(metres, metres < 1 ? 1 : 0) + " m";
}

}  // namespace

std::string road_map_svg(const FlightReportInput& input) {
  std::vector<std::array<double, 2>> points;
  for (const auto& point : input.track_deg) {
    if (std::isfinite(point[0]) && std::isfinite(point[1])) points.push_back(point);
  }
  if (points.empty()) return "";
  for (const ReportedDamage& reported : input.damages) {
    const std::optional<GeoPosition>& position = reported.damage.position;
    if (position) points.push_back({position->lon_deg, position->lat_deg});
  }
  const Projection map(points);
  Dots dots(map);
  for (std::size_t i = 0; i < input.damages.size(); ++i) dots.add(input.damages[i].damage, i < max_damage_rows);
  const double bar_m = round_length(width / 5 / map.pixels_per_metre());
  const auto [x, y] = map.at(points.front()[0], points.front()[1]);
  return fill(flight_templates::map, {{"width", number_text(width, 0)},
                                      {"height", number_text(map.height(), 0)},
                                      {"track", path_of(input, map)},
                                      {"start_x", coordinate(x)},
                                      {"start_y", coordinate(y)},
                                      {"dots", dots.svg()},
                                      {"bar", coordinate(bar_m * map.pixels_per_metre())},
                                      {"bar_y", coordinate(map.height() - 14)},
                                      {"bar_text_y", coordinate(map.height() - 22)},
                                      {"bar_text", metres_text(bar_m)}});
}

}  // namespace roadstereo::io

#include "evaluate/roll_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/degrees.hpp"
#include "synth/hash.hpp"

namespace roadstereo::cli {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

float nearest_value(const Image<float>& map, double u, double v) {
  const auto column = static_cast<int>(std::lround(u));
  const auto row = static_cast<int>(std::lround(v));
  const bool inside = column >= 0 && row >= 0 && column < map.width() && row < map.height();
  return inside ? map(column, row) : nan;
}

float bilinear_value(const Image<float>& map, double u, double v) {
  if (u < 0 || v < 0 || u > map.width() - 1 || v > map.height() - 1) return nan;
  const int left = std::min(static_cast<int>(u), map.width() - 2);
  const int top = std::min(static_cast<int>(v), map.height() - 2);
  const double right_share = u - left;
  const double lower_share = v - top;
  const auto row_value = [&](int row) { return (1 - right_share) * map(left, row) + right_share * map(left + 1, row); };
  return static_cast<float>((1 - lower_share) * row_value(top) + lower_share * row_value(top + 1));
}

}  // namespace

synth::Scene roll_scene(const RollView& view, double roll_deg, bool damaged, double camber) {
  synth::Scene scene;
  scene.supersampling = 1;
  scene.rig.camera_height_m = view.height_m;
  scene.rig.pitch_deg = view.pitch_deg;
  scene.rig.roll_deg = roll_deg;
  scene.road.camber = camber;
  if (!damaged) return scene;
  // Near the point that is seen in the lower part of the image; sizes are proportional to its distance.
  const double angle = to_radians(view.pitch_deg + 10);
  const double distance = view.height_m / std::sin(angle);
  const double ahead = view.height_m / std::tan(angle);
  scene.road.blobs = {{0.35 * distance, ahead, 0.13 * distance, 0.08, 0.30, 0.25, 61},
                      {-0.40 * distance, ahead + 0.25 * distance, 0.09 * distance, 0.06, 0.30, 0.30, 62},
                      {0.20 * distance, ahead + 0.40 * distance, 0.12 * distance, -0.05, 0.20, 0.70, 63}};
  return scene;
}

Image<float> rotate_map(const Image<float>& map, double roll_rad, Resampling resampling) {
  const double centre_u = (map.width() - 1) / 2.0;
  const double centre_v = (map.height() - 1) / 2.0;
  const double c = std::cos(roll_rad), s = std::sin(roll_rad);
  Image<float> rotated(map.width(), map.height());
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      const double x = centre_u + (u - centre_u) * c + (v - centre_v) * s;  // eq. (18), x
      const double y = centre_v + (v - centre_v) * c - (u - centre_u) * s;  // eq. (19), y
      rotated(u, v) = resampling == Resampling::nearest ? nearest_value(map, x, y) : bilinear_value(map, x, y);
    }
  }
  return rotated;
}

void add_outliers(Image<float>& map, double share, std::uint64_t seed) {
  float max_disparity = 0;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) max_disparity = std::fmax(max_disparity, map(u, v));
  }
  std::mt19937_64 random(seed);
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (std::isnan(map(u, v)) || synth::unit_interval(random()) >= share) continue;
      map(u, v) = static_cast<float>(synth::unit_interval(random()) * static_cast<double>(max_disparity));
    }
  }
}

}  // namespace roadstereo::cli

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {

/// What a perfect detector would find in a synthetic pair, with the maps that belong to it.
struct TrueDamage {
  DamageMap map;
  Image<float> disparity;    ///< NaN where the right camera sees nothing
  Image<float> transformed;  ///< around 30 px
};

inline constexpr double true_road_px = 30;

namespace truth {

inline constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

/// Where the pixels of a damage lie, on the image and on the road.
struct Points {
  std::vector<std::array<int, 2>> pixel;
  std::vector<std::array<double, 2>> road;
};

inline Points points_of(const synth::SyntheticPair& pair, int id) {
  const RoadAxes frame = road_axes(ground_plane(pair.plane, pair.calibration));
  Points points;
  for (int v = 0; v < pair.labels.height(); ++v) {
    for (int u = 0; u < pair.labels.width(); ++u) {
      if (pair.labels(u, v) != id || !std::isfinite(pair.disparity(u, v))) continue;
      const auto at = frame.to_road(pair.calibration.point_m(u, v, pair.disparity(u, v)));
      points.pixel.push_back({u, v});
      points.road.push_back({at[0], at[1]});
    }
  }
  return points;
}

/// Extents along and across the axis of largest variance, and its angle.
inline std::array<double, 3> extents(const std::vector<std::array<double, 2>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& p : points) {
    x += p[0] / n;
    y += p[1] / n;
  }
  for (const auto& p : points) {
    xx += (p[0] - x) * (p[0] - x);
    xy += (p[0] - x) * (p[1] - y);
    yy += (p[1] - y) * (p[1] - y);
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  double low_a = 1e9, high_a = -1e9, low_b = 1e9, high_b = -1e9;
  for (const auto& p : points) {
    const double a = std::cos(angle) * p[0] + std::sin(angle) * p[1];
    const double b = std::cos(angle) * p[1] - std::sin(angle) * p[0];
    low_a = std::min(low_a, a);
    high_a = std::max(high_a, a);
    low_b = std::min(low_b, b);
    high_b = std::max(high_b, b);
  }
  return {high_a - low_a, high_b - low_b, angle};
}

inline DamageMetrics metrics_of(const synth::SyntheticPair& pair, const synth::DamageTruth& known, const Points& points,
                                const std::array<int, 2>& middle) {
  DamageMetrics metrics;
  metrics.area_m2 = {known.area_m2, 0.02 * known.area_m2};
  metrics.max_depth_m = {known.depth_m, 0.0012};
  metrics.mean_depth_m = {known.mean_depth_m, 0.0004};
  metrics.volume_m3 = {known.volume_m3, 0.03 * known.volume_m3};
  const auto [length, width, angle] = extents(points.road);
  metrics.length_m = length;
  metrics.width_m = width;
  metrics.angle_rad = angle;
  metrics.diameter_m = 2 * std::sqrt(known.area_m2 / std::numbers::pi);
  const double on_plane = pair.plane.disparity(middle[0], middle[1]);
  metrics.centroid_m = pair.calibration.point_m(middle[0], middle[1], on_plane);
  const RoadAxes frame = road_axes(ground_plane(pair.plane, pair.calibration));
  const auto on_road = frame.to_road(metrics.centroid_m);
  metrics.road_centroid_m = {on_road[0], on_road[1]};
  metrics.distance_m = std::hypot(metrics.centroid_m[0], metrics.centroid_m[1], metrics.centroid_m[2]);
  metrics.resolvable_depth_m = 0.006;
  metrics.wall_slope = 1;
  metrics.distress = known.kind == "bump"    ? Distress::bump
                     : known.kind == "crack" ? Distress::crack
                                             : Distress::pothole;
  metrics.quantity = 1;
  static const SeverityScheme scheme = astm_d6433();
  metrics.severity = known.depth_m < metrics.resolvable_depth_m
                         ? Severity::unresolvable
                         : scheme.find(Distress::pothole)->severity(known.depth_m, metrics.diameter_m);
  return metrics;
}

inline Damage damage_of(const synth::SyntheticPair& pair, const DamageMap& map, const synth::DamageTruth& known,
                        const Image<float>& disparity, const Image<float>& transformed) {
  const Points points = points_of(pair, known.id);
  Damage damage;
  damage.id = known.id;
  damage.kind = known.kind == "bump" ? DamageKind::protrusion : DamageKind::depression;
  damage.pixels = points.pixel.size();
  damage.box_px = {1 << 20, 1 << 20, -1, -1};
  double deepest = -1;
  for (const auto& [u, v] : points.pixel) {
    auto& [u0, v0, u1, v1] = damage.box_px;
    damage.box_px = {std::min(u0, u), std::min(v0, v), std::max(u1, u), std::max(v1, v)};
    const double n = static_cast<double>(points.pixel.size());
    damage.centroid_px = {damage.centroid_px[0] + u / n, damage.centroid_px[1] + v / n};
    if (std::isfinite(disparity(u, v))) damage.measured_share += 1 / n;
    const double depth = std::abs(map.depth(u, v));
    if (depth > deepest) damage.deepest_px = {u, v};
    deepest = std::max(deepest, depth);
    const double change = std::abs(transformed(u, v) - true_road_px);
    if (change > damage.max_depth_px.value) damage.max_depth_px = {change, 0.05};
    if (std::isfinite(change)) damage.mean_depth_px += change / n;
  }
  const auto& [u0, v0, u1, v1] = damage.box_px;
  damage.cut_by_border = u0 == 0 || v0 == 0 || u1 == pair.labels.width() - 1 || v1 == pair.labels.height() - 1;
  const std::array<int, 2> middle{static_cast<int>(damage.centroid_px[0]), static_cast<int>(damage.centroid_px[1])};
  if (damage.kind == DamageKind::depression) damage.evidence.likely_wall_slope = 1;
  if (map.metric) damage.metrics = metrics_of(pair, known, points, middle);
  return damage;
}

}  // namespace truth

/// The truth of the pair as a DamageMap: depths and disparities exact, metrics from the height field, standard errors
/// made up. Uncalibrated: depths in pixels, nothing metric.
inline TrueDamage damage_from_truth(const synth::SyntheticPair& pair, bool calibrated = true) {
  const int width = pair.labels.width(), height = pair.labels.height();
  const GroundPlane plane = ground_plane(pair.plane, pair.calibration);
  TrueDamage found{{}, Image<float>(width, height, truth::nan_value), Image<float>(width, height, truth::nan_value)};
  DamageMap& map = found.map;
  map.ids = pair.labels;
  map.road.assign(width, height, 255);
  map.surface.assign(width, height, static_cast<float>(true_road_px));
  map.depth.assign(width, height, truth::nan_value);
  map.noise_px = 0.05;
  map.metric = calibrated;
  if (!calibrated) map.non_metric_reason = "no calibration was given";
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double d = pair.disparity(u, v);
      const double change = d - pair.plane.disparity(u, v);
      const auto p = pair.calibration.point_m(u, v, d);
      const auto& n = plane.normal;
      const double depth_m = n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - plane.height_m;
      map.depth(u, v) = static_cast<float>(calibrated ? depth_m : -change);
      if (pair.visible(u, v) == 0) continue;
      found.disparity(u, v) = static_cast<float>(d);
      found.transformed(u, v) = static_cast<float>(change + true_road_px);
    }
  }
  for (const synth::DamageTruth& known : pair.damages) {
    const auto* const first = pair.labels.row(0);
    if (std::find(first, first + pair.labels.pixels(), known.id) == first + pair.labels.pixels()) continue;
    map.damages.push_back(truth::damage_of(pair, map, known, found.disparity, found.transformed));
  }
  std::stable_sort(map.damages.begin(), map.damages.end(), [](const Damage& a, const Damage& b) {
    return a.metrics && b.metrics ? a.metrics->max_depth_m.value > b.metrics->max_depth_m.value
                                  : a.max_depth_px.value > b.max_depth_px.value;
  });
  return found;
}

}  // namespace roadstereo

#include "damage/metric_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/order_statistics.hpp"
#include "damage/morphology.hpp"
#include "damage/oriented_box.hpp"
#include "damage/pixel_runs.hpp"
#include "damage/road_outline.hpp"
#include "damage/road_undulation.hpp"
#include "damage/smoothing_error.hpp"
#include "roadstereo/resolution_limits.hpp"

namespace roadstereo {
namespace {

using Point = FrameGeometry::Point;

/// Sums over the pixels of one damage.
struct MetricSums {
  double area = 0, volume = 0;             ///< m², m³ (negative for protrusions)
  Point centroid{};                        ///< weighted by area
  double metres_per_pixel = 0;             ///< weighted by area
  double variance = 0;                     ///< of the disparities, px²
  std::size_t sigma_pixels = 0;            ///< pixels with a standard error
  std::vector<std::array<double, 2>> rim;  ///< corners of its pixels on the road
  double perimeter = 0;                    ///< metres
  double quarter_m2 = 0;                   ///< area deeper than a quarter of the maximum depth
  double three_quarters_m2 = 0;            ///< area deeper than three quarters of it
};

/// Values of neighbouring pixels of a row, computed together.
struct PixelValues {
  static constexpr int max_count = 32;
  template <class Value>
  using Row = std::array<Value, max_count>;

  Row<double> area, depth_share, volume, metres_per_pixel;
  Row<double> x, y, z;  ///< on the road
};

/// Values of the pixels from (u, v) on. The surface is raised by `offset`, pixels of ℓ'. `max_depth_m` is negative for
/// protrusions. Powers of the depths instead of quotients leave three divisions a pixel.
void compute_values(const FrameGeometry& geometry, const DamageMap& maps, double offset, double max_depth_m, int u,
                    int v, int count, PixelValues& values) {
  const StereoCalibration& rig = geometry.calibration();
  const double inverse_f = 1 / rig.focal_px, inverse_f2 = inverse_f * inverse_f,
               inverse_fb = inverse_f / rig.baseline_m;
  const double inverse_depth = 1 / max_depth_m, y = (v - rig.cy_px) * inverse_f;
  const float *const surface = maps.surface.row(v) + u, *const depths = maps.depth.row(v) + u;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double road_disparity = geometry.road_disparity(u + i, v, surface[i] + offset);
    const double road_z = rig.depth_m(road_disparity), z = rig.depth_m(road_disparity - (depths[i] + offset));
    const double x = (u + i - rig.cx_px) * inverse_f, per_z = geometry.distance({x, y, 1}), road_z2 = road_z * road_z;
    values.area[k] = road_z2 * inverse_f2 / per_z;
    values.depth_share[k] = (z - road_z) * per_z * inverse_depth;
    values.volume[k] = (z * z * z - road_z2 * road_z) * (inverse_f2 / 3);
    values.metres_per_pixel[k] = road_z2 * inverse_f2 * (z * z * inverse_fb);
    values.x[k] = x * road_z;
    values.y[k] = y * road_z;
    values.z[k] = road_z;
  }
}

/// Sum over the pixels of a damage, `max_depth_m` deep. Its surface is raised by `offset`, pixels of ℓ'.
MetricSums sum_pixels(const DamageInput& input, const FrameGeometry& geometry, const DamageMap& maps,
                      const Damage& damage, double offset, double max_depth_m) {
  MetricSums sums;
  PixelValues values;
  const auto add_pixel = [&](int u, int v, std::size_t k, bool is_on_rim) {
    const double area = values.area[k];
    const Point road{values.x[k], values.y[k], values.z[k]};
    sums.area += area;
    sums.quarter_m2 += values.depth_share[k] > 0.25 ? area : 0;
    sums.three_quarters_m2 += values.depth_share[k] > 0.75 ? area : 0;
    sums.volume += values.volume[k];
    for (std::size_t axis = 0; axis < 3; ++axis) sums.centroid[axis] += area * road[axis];
    sums.metres_per_pixel += values.metres_per_pixel[k];
    if (!input.sigma.empty() && std::isfinite(input.sigma(u, v))) {
      sums.variance += static_cast<double>(input.sigma(u, v)) * input.sigma(u, v);
      ++sums.sigma_pixels;
    }
    if (!is_on_rim) return;
    for (const auto& [right, down] : {std::array{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}}) {
      const auto corner = geometry.road_position(u + right, v + down);
      if (std::isfinite(corner[0] + corner[1])) sums.rim.push_back(corner);
    }
    sums.perimeter += std::sqrt(area);
  };
  const auto& [u0, v0, u1, v1] = damage.box_px;
  for_each_run(maps.ids, damage.id, {u0, v0, u1, v1}, [&](int v, int first, int last) {
    // A pixel of the rim has a 4-neighbour outside its damage.
    const int bottom = maps.ids.height() - 1;
    const bool at_border = v == 0 || v == bottom;
    const std::uint16_t* const above = maps.ids.row(std::max(v - 1, 0));
    const std::uint16_t* const below = maps.ids.row(std::min(v + 1, bottom));
    const auto is_on_rim = [&](int u) {
      return u == first || u == last || at_border || above[u] != damage.id || below[u] != damage.id;
    };
    for (int u = first; u <= last; u += PixelValues::max_count) {
      const int count = std::min(last + 1 - u, PixelValues::max_count);
      compute_values(geometry, maps, offset, sign_of(damage.kind) * max_depth_m, u, v, count, values);
      for (int i = 0; i < count; ++i) add_pixel(u + i, v, static_cast<std::size_t>(i), is_on_rim(u + i));
    }
  });
  return sums;
}

/// Mean slope of the wall: half of the depth over the mean distance between the contours at a quarter and three
/// quarters of it, the area between them over the mean of their perimeters, taken as those of ellipses.
double wall_slope(const MetricSums& sums, const DamageMetrics& metrics) {
  const double aspect = metrics.width_m > 0 ? metrics.length_m / metrics.width_m : 1;
  const double perimeter_per_root_area = std::sqrt(2 * std::numbers::pi * (aspect * aspect + 1) / aspect);
  const double mean_perimeter =
      0.5 * perimeter_per_root_area * (std::sqrt(sums.quarter_m2) + std::sqrt(sums.three_quarters_m2));
  const double run = (sums.quarter_m2 - sums.three_quarters_m2) / mean_perimeter;
  return 0.5 * metrics.max_depth_m.value / std::max(run, std::sqrt(sums.area) * 1e-3);
}

/// Corners of the outline on the road.
std::vector<std::array<double, 2>> outline_on_road(const FrameGeometry& geometry, const DamageMap& maps,
                                                   const Damage& damage) {
  constexpr double tolerance_px = 2;  // the outline is not known better: set_standard_errors
  std::vector<std::array<double, 2>> outline = trace_outline(maps.ids, damage, tolerance_px);
  std::reverse(outline.begin(), outline.end());  // counterclockwise seen from above
  for (std::array<double, 2>& corner : outline) corner = geometry.road_position(corner[0], corner[1]);
  return outline;
}

/// Set area, centroid, outline and what follows from them.
void set_shape(const FrameGeometry& geometry, const MetricSums& sums, const DamageMap& maps, const Damage& damage,
               DamageMetrics& metrics) {
  metrics.area_m2.value = sums.area;
  metrics.diameter_m = 2 * std::sqrt(sums.area / std::numbers::pi);
  const OrientedBox box = oriented_box(sums.rim);
  metrics.length_m = box.length;
  metrics.width_m = box.width;
  metrics.angle_rad = box.angle_rad;
  for (std::size_t k = 0; k < 3; ++k) metrics.centroid_m[k] = sums.centroid[k] / sums.area;
  const Point on_road = geometry.axes().to_road(metrics.centroid_m);
  metrics.road_centroid_m = {on_road[0], on_road[1]};
  metrics.distance_m = std::hypot(metrics.centroid_m[0], metrics.centroid_m[1], metrics.centroid_m[2]);
  metrics.outline_m = outline_on_road(geometry, maps, damage);
}

/// Set the standard errors. They combine the errors of the disparity, of the undamaged surface, of the smoothing by the
/// support window of matching, and of the outline. The constants of the last two were measured on synthetic roads
/// (docs/damage_accuracy.md): a hollow of the size of the window loses part of its depth, and the outline is accurate
/// to a fifth of the window's radius.
void set_standard_errors(const MetricSums& sums, const SurfaceOffset& offset, double noise_px, double sigma_px,
                         double deepest_m_per_px, const Damage& damage, DamageMetrics& metrics) {
  constexpr double mean_factor = 0.3;     // error of the mean depth, relative to that of one pixel
  constexpr double outline_factor = 0.2;  // error of the outline, relative to the radius of the window
  const double radius_px = std::sqrt(static_cast<double>(damage.pixels) / std::numbers::pi);
  const SmoothingError smoothing(static_cast<double>(damage.pixels));
  const double pixel_m = std::sqrt(sums.area / static_cast<double>(damage.pixels));
  const double surface_px = std::hypot(offset.std_error, sub_pixel_bias_px);

  metrics.max_depth_m.std_error =
      std::hypot(damage.max_depth_px.std_error * deepest_m_per_px, smoothing.max_depth(metrics.max_depth_m.value));
  // The foot of a gentle wall is located to the distance over which it rises by two standard deviations.
  const double foot_px =
      radius_px * std::min(1.0, 2 * std::hypot(noise_px, offset.std_error) / damage.max_depth_px.value);
  metrics.area_m2.std_error =
      sums.perimeter * std::hypot(outline_factor * SmoothingError::window_radius_px, foot_px) * pixel_m;
  const double mean_m = std::hypot(surface_px, mean_factor * sigma_px) * sums.metres_per_pixel / sums.area;
  metrics.mean_depth_m.std_error = std::hypot(mean_m, smoothing.mean_depth(metrics.mean_depth_m.value));
  metrics.volume_m3.std_error = std::hypot(sums.area * mean_m, smoothing.volume(metrics.volume_m3.value));
  if (!damage.ends_search) return;
  for (Measurement* depth : {&metrics.max_depth_m, &metrics.mean_depth_m, &metrics.volume_m3}) {
    depth->std_error = std::max(depth->std_error, depth->value);
  }
}

}  // namespace

SurfaceOffset estimate_surface_offset(const Segmentation& segmentation, const Candidate& candidate) {
  constexpr int inner_margin = 3;          // cells; closer to the rim the disparity of the wall is smoothed
  constexpr float max_sigmas = 3;          // deeper cells are other damage or a hollow
  constexpr double effective_samples = 6;  // independent undulations of the road on the ring
  const DepthCells& depth_cells = segmentation.depth_cells;
  const double radius = std::sqrt(static_cast<double>(candidate.size) / std::numbers::pi);
  const int outer_margin = inner_margin + std::max(3, static_cast<int>(0.4 * radius));
  const CellBox box = candidate.box().grown(outer_margin, segmentation.cells.width(), segmentation.cells.height());
  const BoxMask inner = dilate(candidate.cells, inner_margin, box);
  const BoxMask outer = dilate(candidate.cells, outer_margin, box);
  std::vector<double> values;
  const float max_depth = max_sigmas * static_cast<float>(depth_cells.noise);
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!outer(i, j) || inner(i, j) || depth_cells.valid(i, j) == 0) continue;
      const float depth = depth_cells.depth(i, j);
      if (std::abs(depth) <= max_depth) values.push_back(-depth);
    }
  }
  constexpr std::size_t min_cells = 20;
  if (values.size() < min_cells) return {0, depth_cells.noise};
  const double median = upper_median(values);
  for (double& value : values) value = std::abs(value - median);
  return {median, gaussian_mad * upper_median(values) / std::sqrt(effective_samples)};
}

double possible_wall_slope(const DamageMetrics& metrics, std::size_t pixels) {
  const double window_m =
      SmoothingError::window_radius_px * std::sqrt(metrics.area_m2.value / static_cast<double>(pixels));
  const double rise = 0.5 * metrics.max_depth_m.value, run = rise / metrics.wall_slope;
  return rise / std::sqrt(std::max(0.0, run * run - window_m * window_m));
}

DamageMetrics compute_metrics(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                              const SurfaceOffset& offset, const DamageMap& maps, Damage& damage) {
  const auto [u, v] = damage.deepest_px;
  const double signed_depth = sign_of(damage.kind) * damage.max_depth_px.value;
  const double road_disparity = geometry.road_disparity(u, v, maps.surface(u, v) + offset.value);
  const Point road = geometry.point(u, v, road_disparity);
  const Point deepest = geometry.point(u, v, road_disparity - signed_depth);
  const double max_depth_m = std::abs(geometry.depth_between(road, deepest));
  const MetricSums sums = sum_pixels(input, geometry, maps, damage, offset.value, max_depth_m);
  const double noise_px = maps.noise_px;
  DamageMetrics metrics;
  const double metres_per_pixel = sums.metres_per_pixel / sums.area;
  const double sigma_px =
      sums.sigma_pixels > 0 ? std::sqrt(sums.variance / static_cast<double>(sums.sigma_pixels)) : noise_px;
  set_shape(geometry, sums, maps, damage, metrics);
  metrics.volume_m3.value = std::abs(sums.volume);
  metrics.mean_depth_m.value = metrics.volume_m3.value / sums.area;
  metrics.max_depth_m.value = std::max(max_depth_m, metrics.mean_depth_m.value);
  set_standard_errors(sums, offset, noise_px, sigma_px,
                      geometry.metres_per_pixel(deepest, road_disparity - signed_depth), damage, metrics);
  metrics.resolvable_depth_m =
      resolvable_change_px(std::hypot(noise_px, offset.std_error), options.threshold_sigma) * metres_per_pixel;
  metrics.wall_slope = wall_slope(sums, metrics);
  const double possible_slope = possible_wall_slope(metrics, damage.pixels);
  if (damage.kind == DamageKind::depression && std::isfinite(sums.area)) {  // else it extends beyond the road
    damage.evidence.likely_wall_slope = std::sqrt(std::min(1.0, metrics.wall_slope) * std::min(1.0, possible_slope));
  }
  if (input.calibration) damage.evidence.extent = metrics.diameter_m / (0.5 * straightedge_m);
  return metrics;
}

void keep_inside_rim(const DamageInput& input, const FrameGeometry& geometry, const SurfaceOffset& offset,
                     const DamageMap& maps, const Damage& damage, DamageMetrics& metrics) {
  const DamageMetrics spread = metrics;
  const MetricSums sums = sum_pixels(input, geometry, maps, damage, offset.value, spread.max_depth_m.value);
  set_shape(geometry, sums, maps, damage, metrics);
  // A wall as gentle as it is measured is possible as well.
  const double area_error = 0.5 * (spread.area_m2.value - sums.area), ratio = spread.area_m2.value / sums.area;
  metrics.area_m2.std_error = std::hypot(spread.area_m2.std_error, area_error);
  Measurement& mean = metrics.mean_depth_m;
  mean.value = metrics.volume_m3.value / sums.area;
  mean.std_error = std::hypot(ratio * spread.mean_depth_m.std_error, mean.value * area_error / sums.area);
  metrics.max_depth_m.value = std::max(metrics.max_depth_m.value, mean.value);
}

}  // namespace roadstereo

#include "damage/metric_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.hpp"
#include "core/parallel.hpp"
#include "damage/grow.hpp"
#include "damage/oriented_box.hpp"

namespace roadstereo {
namespace {

using Point = FrameGeometry::Point;

/// Sums over the pixels of one damage.
struct Sums {
  double area = 0, volume = 0;
  Point centroid{};
  double metres_per_pixel = 0, sigma = 0;
  std::size_t measured = 0;
  std::vector<std::array<double, 2>> rim;  ///< on the road
  double perimeter = 0;                    ///< metres
};

bool on_rim(const Image<std::uint16_t>& ids, int u, int v) {
  const std::uint16_t id = ids(u, v);
  return u == 0 || v == 0 || u + 1 == ids.width() || v + 1 == ids.height() || ids(u - 1, v) != id ||
         ids(u + 1, v) != id || ids(u, v - 1) != id || ids(u, v + 1) != id;
}

Sums add_up(const DamageInput& input, const FrameGeometry& geometry, const DamageMap& maps, const Damage& damage,
            double offset) {
  Sums sums;
  const double f = geometry.focal_px();
  for (int v = damage.box_px[1]; v <= damage.box_px[3]; ++v) {
    for (int u = damage.box_px[0]; u <= damage.box_px[2]; ++u) {
      if (maps.ids(u, v) != damage.id) continue;
      const double on_road = geometry.road_disparity(u, v, maps.surface(u, v) + offset);
      const double seen = on_road - (maps.depth(u, v) + offset);
      const Point road = geometry.point(u, v, on_road);
      const Point point = geometry.point(u, v, seen);
      const double area = geometry.pixel_area(road);
      sums.area += area;
      sums.volume += (point[2] * point[2] * point[2] - road[2] * road[2] * road[2]) / (3 * f * f);
      for (std::size_t k = 0; k < 3; ++k) sums.centroid[k] += area * road[k];
      sums.metres_per_pixel += area * geometry.metres_per_pixel(point, seen);
      if (!input.sigma.empty() && std::isfinite(input.sigma(u, v))) {
        sums.sigma += static_cast<double>(input.sigma(u, v)) * input.sigma(u, v);
        ++sums.measured;
      }
      if (!on_rim(maps.ids, u, v)) continue;
      const Point flat = geometry.frame().to_road(road);
      sums.rim.push_back({flat[0], flat[1]});
      sums.perimeter += std::sqrt(area);
    }
  }
  return sums;
}

/// Standard errors: of the disparity (of one place for the largest depth, less for a mean), of the undamaged surface,
/// of what matching does to a small hollow, and of the outline. The last two were measured on synthetic roads
/// (docs/accuracy.md): matching sees through a window, so that a hollow of its size loses part of its depth and its
/// outline is known to a fifth of it.
void set_standard_errors(const Sums& sums, const SurfaceOffset& offset, double noise_px, double sigma_px,
                         double deepest_m_per_px, DamageMetrics& metrics, Damage& damage) {
  constexpr double window_px = 10;       // radius of the block and of the aggregation
  constexpr double sub_pixel_px = 0.03;  // bias that the phase of the sub-pixel step leaves
  constexpr double of_mean = 0.3;        // of the error of one pixel, for the mean of a region
  constexpr double outline = 0.2;        // of the window
  const double radius_px = std::sqrt(static_cast<double>(damage.pixels) / std::numbers::pi);
  const double smear = window_px / radius_px * (1 + window_px / radius_px);
  const double pixel_m = std::sqrt(sums.area / static_cast<double>(damage.pixels));
  const double surface_px = std::hypot(offset.std_error, sub_pixel_px);

  damage.max_depth_px.std_error = std::hypot(damage.max_depth_px.std_error, sub_pixel_px);
  metrics.max_depth_m.std_error =
      std::hypot(damage.max_depth_px.std_error * deepest_m_per_px, 0.2 * smear * metrics.max_depth_m.value);
  // A gentle foot ends where it drops below what can be told from the road.
  const double foot_px =
      radius_px * std::min(1.0, 2 * std::hypot(noise_px, offset.std_error) / damage.max_depth_px.value);
  metrics.area_m2.std_error = sums.perimeter * std::hypot(outline * window_px, foot_px) * pixel_m;
  const double mean_m = std::hypot(surface_px, of_mean * sigma_px) * sums.metres_per_pixel / sums.area;
  metrics.mean_depth_m.std_error = std::hypot(mean_m, 0.5 * smear * metrics.mean_depth_m.value);
  metrics.volume_m3.std_error = std::hypot(sums.area * mean_m, 0.25 * smear * metrics.volume_m3.value);
}

/// Everything metric of one damage.
DamageMetrics metrics_of(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                         const SurfaceOffset& offset, const DamageMap& maps, Damage& damage) {
  const Sums sums = add_up(input, geometry, maps, damage, offset.value);
  const double noise_px = maps.noise_px;
  DamageMetrics metrics;
  const double per_pixel = sums.metres_per_pixel / sums.area;
  const double sigma_px = sums.measured > 0 ? std::sqrt(sums.sigma / static_cast<double>(sums.measured)) : noise_px;
  metrics.area_m2.value = sums.area;
  metrics.volume_m3.value = std::abs(sums.volume);
  metrics.mean_depth_m.value = metrics.volume_m3.value / sums.area;
  const auto [u, v] = damage.deepest_px;
  const double signed_depth = sign_of(damage.kind) * damage.max_depth_px.value;
  const double on_road = geometry.road_disparity(u, v, maps.surface(u, v) + offset.value);
  const Point road = geometry.point(u, v, on_road);
  const Point deepest = geometry.point(u, v, on_road - signed_depth);
  metrics.max_depth_m.value = std::abs(geometry.depth_between(road, deepest));
  set_standard_errors(sums, offset, noise_px, sigma_px, geometry.metres_per_pixel(deepest, on_road - signed_depth),
                      metrics, damage);

  const OrientedBox box = oriented_box(sums.rim);
  metrics.length_m = box.length;
  metrics.width_m = box.width;
  metrics.angle_rad = box.angle_rad;
  metrics.diameter_m = 2 * std::sqrt(sums.area / std::numbers::pi);
  for (std::size_t k = 0; k < 3; ++k) metrics.centroid_m[k] = sums.centroid[k] / sums.area;
  const Point flat = geometry.frame().to_road(metrics.centroid_m);
  metrics.road_centroid_m = {flat[0], flat[1]};
  metrics.distance_m = std::hypot(metrics.centroid_m[0], metrics.centroid_m[1], metrics.centroid_m[2]);
  metrics.resolvable_depth_m = options.threshold_sigma * std::hypot(sigma_px, offset.std_error) * per_pixel;
  metrics.severity = metrics.max_depth_m.value < metrics.resolvable_depth_m
                         ? Severity::unresolvable
                         : astm_severity(metrics.max_depth_m.value, metrics.diameter_m);
  return metrics;
}

}  // namespace

SurfaceOffset local_surface_offset(const Segmentation& found, const Candidate& candidate) {
  constexpr int gap = 3;             // cells; nearer the rim the wall is smeared
  constexpr float noise_reach = 3;   // beyond it is another damage, or a hollow
  constexpr double independent = 6;  // undulations of the road around one damage that do not know of each other
  const double radius = std::sqrt(static_cast<double>(candidate.size) / std::numbers::pi);
  const int reach = gap + std::max(3, static_cast<int>(0.4 * radius));
  const Box box = candidate.box().grown(reach, found.cells.width(), found.cells.height());
  const BoxMask inner = grow(candidate.cells, gap, box);
  const BoxMask outer = grow(candidate.cells, reach, box);
  std::vector<double> values;
  const float most = noise_reach * static_cast<float>(found.relief.noise);
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!outer(i, j) || inner(i, j) || found.relief.known(i, j) == 0) continue;
      const float depth = found.relief.depth(i, j);
      if (std::abs(depth) <= most) values.push_back(-depth);
    }
  }
  constexpr std::size_t least_cells = 20;
  if (values.size() < least_cells) return {0, found.relief.noise};
  const double median = take_median(values);
  for (double& value : values) value = std::abs(value - median);
  return {median, gaussian_mad * take_median(values) / std::sqrt(independent)};
}

void measure_in_metres(const DamageInput& input, const DamageOptions& options, const FrameGeometry& geometry,
                       const std::vector<SurfaceOffset>& offsets, DamageMap& result) {
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    Damage& damage = result.damages[k];
    if (damage.pixels > 0) damage.metrics = metrics_of(input, options, geometry, offsets[k], result, damage);
  }
}

void depth_to_metres(const FrameGeometry& geometry, int threads, DamageMap& result) {
  constexpr int rows_per_band = 16;
  parallel_rows(result.depth.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      geometry.depths_to_metres(v, result.depth.width(), result.surface.row(v), result.depth.row(v));
    }
  });
}

}  // namespace roadstereo

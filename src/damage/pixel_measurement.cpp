#include "damage/pixel_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "damage/damage_maps.hpp"
#include "damage/pixel_runs.hpp"
#include "damage/surface_correlation.hpp"
#include "road/refinement/smoothing_bias.hpp"
#include "roadstereo/resolution_limits.hpp"

namespace roadstereo {
namespace {

/// Error of smoothing over `reach` pixels at (u, v) of a map; 0 at its border.
double smoothing_error(ImageView<const float> map, int reach, int u, int v) {
  const bool inside = u >= reach && v >= reach && u + reach < map.width() && v + reach < map.height();
  if (reach == 0 || !inside) return 0;
  return with_smoothing_bias(0, map(u, v), map(u - reach, v) + map(u + reach, v),
                             map(u, v - reach) + map(u, v + reach));
}

/// Variance of the disparity at (u, v) by noise alone, without the error of smoothing; NaN without a measurement, 0 or
/// less by rounding.
double noise_variance(const DamageInput& input, int u, int v) {
  const int reach = input.disparity.empty() ? 0 : input.smoothing_px;
  const double sigma = input.sigma(u, v), smoothing = smoothing_error(input.disparity, reach, u, v);
  return sigma * sigma - smoothing * smoothing;
}

/// Upper quartile of the depths in their standard errors, of every second pixel of every second row; NaN without any.
double pixel_significance(const DamageInput& input, const DamageMap& maps, double offset, const Damage& damage) {
  constexpr double quartile = 0.75;
  if (input.sigma.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<float> significances;
  const auto& [u0, v0, u1, v1] = damage.box_px;
  for_each_run(maps.ids, damage.id, {u0, v0, u1, v1}, [&](int v, int first, int last) {
    if (v % 2 != 0) return;
    for (int u = first + first % 2; u <= last; u += 2) {
      const double variance = noise_variance(input, u, v);
      if (!(std::abs(input.transformed(u, v)) <= max_map_value) || !(variance > 0) || !std::isfinite(variance)) {
        continue;
      }
      const double off_road = sign_of(damage.kind) * (double{maps.depth(u, v)} + offset);
      significances.push_back(static_cast<float>(off_road / std::sqrt(variance)));
    }
  });
  if (significances.empty()) return std::numeric_limits<double>::quiet_NaN();
  return double{lower_quantile(significances, quartile)};
}

/// Root mean square of the standard errors of the pixels of a cell without their errors of smoothing; `noise` where
/// there are none, without measurement.
double cell_noise(const DamageInput& input, const Cells& cells, int i, int j, double noise) {
  if (input.sigma.empty()) return noise;
  double sum = 0;
  int count = 0;
  for (int v = j * cells.factor; v < std::min((j + 1) * cells.factor, cells.image_height); ++v) {
    for (int u = i * cells.factor; u < std::min((i + 1) * cells.factor, cells.image_width); ++u) {
      const double variance = noise_variance(input, u, v);
      if (!std::isfinite(variance)) continue;
      sum += variance;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(std::max(0.0, sum) / count) : noise;
}

/// Find the smoothed depth cell that is deepest for certain: the one with the largest depth on the road, less its
/// standard error from noise, so that what is measured badly is not the deepest because of that. Returns that standard
/// error.
double find_deepest(const DamageInput& input, const Segmentation& segmentation, const Candidate& candidate,
                    Damage& damage) {
  const float sign = sign_of(candidate.kind);
  const Cells& cells = segmentation.cells;
  const DepthCells& depths = segmentation.depth_cells;
  double max_bound = -HUGE_VAL, deepest_noise = depths.noise;
  const int reach = (input.smoothing_px + cells.factor / 2) / cells.factor;
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      const float depth = sign * depths.depth(i, j);
      if (!candidate.cells(i, j) || depths.valid(i, j) == 0 || depth <= 0) continue;
      const double scale = segmentation.coordinates.scale(i, j);  // to first order
      if (!(depth > max_bound * scale)) continue;                 // whatever its noise
      const double noise = cell_noise(input, cells, i, j, depths.noise);
      const double bound = (static_cast<double>(depth) - noise) / scale;
      if (bound <= max_bound) continue;
      max_bound = bound;
      deepest_noise = noise;
      damage.max_depth_px = {depth, std::hypot(noise, smoothing_error(depths.depth, reach, i, j))};
      // The centre of a cell that the border clips may lie outside the image.
      damage.deepest_px = {std::min(static_cast<int>(cells.middle(i)), cells.image_width - 1),
                           std::min(static_cast<int>(cells.middle(j)), cells.image_height - 1)};
    }
  }
  return deepest_noise;
}

/// Whether the floor of a depression lies where the searched disparities end.
bool ends_search(const DamageInput& input, const DamageMap& maps, const Damage& damage) {
  constexpr float margin_px = 1;
  constexpr std::size_t noteworthy = 20;  // one in so many pixels
  const bool searched = input.shift && input.shift->enabled && !input.disparity.empty();
  if (damage.kind != DamageKind::depression || !searched) return false;
  std::size_t at_end = 0;
  for (int v = damage.box_px[1]; v <= damage.box_px[3]; ++v) {
    for (int u = damage.box_px[0]; u <= damage.box_px[2]; ++u) {
      const bool inside = maps.ids(u, v) == damage.id;
      at_end += inside && input.disparity(u, v) < static_cast<float>(input.shift->at(u, v)) + margin_px ? 1U : 0U;
    }
  }
  return noteworthy * at_end > damage.pixels;
}

}  // namespace

void count_pixels(const DamageInput& input, const DamageMap& maps, double offset, const PixelBox& box, Damage& damage) {
  damage.pixels = 0;
  std::int64_t sum_u = 0, sum_v = 0;
  double depth = 0;
  std::size_t measured = 0;
  for_each_run(maps.ids, damage.id, box, [&](int v, int first, int last) {
    if (damage.pixels == 0) damage.box_px = {first, v, last, v};
    damage.box_px = {std::min(damage.box_px[0], first), std::min(damage.box_px[1], v), std::max(damage.box_px[2], last),
                     std::max(damage.box_px[3], v)};
    const int count = last - first + 1;
    damage.pixels += static_cast<std::size_t>(count);
    sum_u += static_cast<std::int64_t>(first + last) * count / 2;
    sum_v += static_cast<std::int64_t>(v) * count;
    const float *const transformed = input.transformed.row(v), *const depths = maps.depth.row(v);
    for (int u = first; u <= last; ++u) {
      if (!(std::abs(transformed[u]) <= max_map_value)) continue;
      ++measured;
      depth += sign_of(damage.kind) * depths[u];
    }
  });
  if (damage.pixels == 0) return;
  const auto pixels = static_cast<double>(damage.pixels);
  damage.centroid_px = {static_cast<double>(sum_u) / pixels, static_cast<double>(sum_v) / pixels};
  damage.measured_share = static_cast<double>(measured) / pixels;
  const double mean = measured > 0 ? depth / static_cast<double>(measured) : 0;
  damage.mean_depth_px = std::max(0.0, mean + sign_of(damage.kind) * offset);
}

Damage measure_in_pixels(const DamageInput& input, const Segmentation& segmentation, std::size_t k,
                         const SurfaceOffset& offset, const DamageMap& maps) {
  const Candidate& candidate = segmentation.candidates[k];
  Damage damage;
  damage.id = static_cast<int>(k + 1);
  damage.kind = candidate.kind;
  damage.evidence = candidate.evidence;
  constexpr double min_unseen_share = 0.1;  // single cells without a measurement cut nothing
  damage.cut_by_border = candidate.evidence.border_share > 0 || candidate.evidence.unseen_share >= min_unseen_share;
  const PixelBox box = pixel_box(candidate, segmentation.cells);
  damage.evidence.surface_significance = surface_significance(input, maps, damage.id, box, offset.value);
  count_pixels(input, maps, offset.value, box, damage);
  damage.evidence.pixel_significance = pixel_significance(input, maps, offset.value, damage);
  const double noise = find_deepest(input, segmentation, candidate, damage);
  Measurement& max_depth = damage.max_depth_px;
  max_depth.value = std::max(max_depth.value + sign_of(damage.kind) * offset.value, damage.mean_depth_px);
  const double bias = maps.metric ? sub_pixel_bias_px : 0;
  max_depth.std_error = std::hypot(max_depth.std_error, offset.std_error, bias);
  damage.evidence.depth_significance = max_depth.value / std::hypot(noise, offset.std_error, bias);
  damage.ends_search = ends_search(input, maps, damage);
  if (damage.ends_search) max_depth.std_error = std::max(max_depth.std_error, max_depth.value);
  return damage;
}

}  // namespace roadstereo

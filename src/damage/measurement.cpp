#include "damage/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "damage/clutter.hpp"
#include "damage/damage_maps.hpp"
#include "damage/distress.hpp"
#include "damage/metric_measurement.hpp"
#include "damage/pixel_runs.hpp"
#include "damage/searched_range.hpp"
#include "damage/specular_excess.hpp"
#include "damage/surface_correlation.hpp"
#include "damage/texture_share.hpp"
#include "road/refinement/smoothing_error.hpp"
#include "roadstereo/resolution_limits.hpp"

namespace roadstereo {
namespace {

/// Error of smoothing over `reach` pixels at (u, v) of a map; 0 at its border.
double smoothing_error(ImageView<const float> map, int reach, int u, int v) {
  const bool inside = u >= reach && v >= reach && u + reach < map.width() && v + reach < map.height();
  if (reach == 0 || !inside) return 0;
  return with_smoothing_error(0, map(u, v), map(u - reach, v) + map(u + reach, v),
                              map(u, v - reach) + map(u, v + reach));
}

/// Variance of the disparity at (u, v) by noise alone, without the error of smoothing; NaN without a measurement, 0 or
/// less by rounding.
double noise_variance(const DamageInput& input, int u, int v) {
  const int reach = input.disparity.empty() ? 0 : input.smoothing_px;
  const double sigma = input.sigma(u, v), smoothing = smoothing_error(input.disparity, reach, u, v);
  return sigma * sigma - smoothing * smoothing;
}

/// Set what is counted over the pixels of a damage in `box`: its own box, their number and centroid, the share that is
/// measured, and the mean depth of these below the surface raised by `offset`, pixels of ℓ'.
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

/// Measure candidate `k` in pixels.
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

/// Whether a region reaches the first or the last column of the view.
bool is_at_side(const Candidate& candidate, const CommonView& view) {
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (candidate.cells(i, j) && view.is_at_side(i, j)) return true;
    }
  }
  return false;
}

/// Measure candidate `k` over all that is deep.
Damage measure_candidate(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                         const std::optional<FrameGeometry>& geometry, std::size_t k, const SurfaceOffset& offset,
                         const DamageMap& result) {
  const Candidate& candidate = segmentation.candidates[k];
  Damage damage = measure_in_pixels(input, segmentation, k, offset, result);
  if (geometry && damage.pixels > 0) {
    DamageMetrics metrics =
        compute_metrics(input, options, *geometry, offset, is_at_side(candidate, segmentation.view), result, damage);
    if (result.metric) damage.metrics = std::move(metrics);
  }
  damage.confidence = damage.evidence.confidence();
  if (damage.confidence >= min_candidate_confidence) {
    const PixelBox box = pixel_box(candidate, segmentation.cells);
    damage.evidence.range_vote = range_vote(input, result, damage.id, box);
    damage.evidence.specular_excess = specular_excess(input, result, damage.id, box);
    if (damage.kind == DamageKind::protrusion) {
      damage.evidence.texture_share = texture_share(input, result, damage.id, box);
    }
    damage.confidence = damage.evidence.confidence();
  }
  return damage;
}

bool ends_at_rim(const Candidate& candidate, const Damage& damage) {
  return damage.metrics && !candidate.inside.box().empty();
}

/// Measure the shape of candidate `k` inside its rim, which is all that `result` keeps of it, and grade it.
void finish_metrics(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    const FrameGeometry& geometry, std::size_t k, const SurfaceOffset& offset, const DamageMap& result,
                    Damage& damage) {
  const Candidate& candidate = segmentation.candidates[k];
  if (ends_at_rim(candidate, damage)) {
    count_pixels(input, result, offset.value, pixel_box(candidate, segmentation.cells), damage);
    if (damage.pixels > 0) keep_inside_rim(input, geometry, offset, result, damage, *damage.metrics);
  }
  const bool resolvable = damage.evidence.is_depth_resolved() || damage.metrics->mean_depth_m.is_resolved();
  grade(options.severity, resolvable, *damage.metrics);
}

/// Measure all candidates. What lies beyond the rim of one is road to the others: none ends at its rim before all are
/// measured, so that results do not depend on the order of threads.
void measure_candidates(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                        const std::optional<FrameGeometry>& geometry, int threads, DamageMap& result) {
  const auto count = static_cast<int>(segmentation.candidates.size());
  const Image<float> interpolated = depth_without_islands(segmentation, threads);
  std::vector<SurfaceOffset> offsets(segmentation.candidates.size());
  parallel_for(count, threads, [&](int index, int) {
    const auto k = static_cast<std::size_t>(index);
    fill_damage(segmentation, k, interpolated, result);
    offsets[k] = estimate_surface_offset(segmentation, segmentation.candidates[k]);
    result.damages[k] = measure_candidate(input, options, segmentation, geometry, k, offsets[k], result);
  });
  for (std::size_t k = 0; k < result.damages.size(); ++k) {
    if (ends_at_rim(segmentation.candidates[k], result.damages[k])) empty_beyond_rim(input, segmentation, k, result);
  }
  parallel_for(count, threads, [&](int index, int) {
    const auto k = static_cast<std::size_t>(index);
    Damage& damage = result.damages[k];
    if (damage.metrics) finish_metrics(input, options, segmentation, *geometry, k, offsets[k], result, damage);
  });
}

/// Box around all damages; empty without pixels.
PixelBox box_around(const std::vector<Damage>& damages) {
  PixelBox box{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), -1, -1};
  for (const Damage& damage : damages) {
    if (damage.pixels == 0) continue;
    const auto& [u0, v0, u1, v1] = damage.box_px;
    box = {std::min(box.u0, u0), std::min(box.v0, v0), std::max(box.u1, u1), std::max(box.v1, v1)};
  }
  return box;
}

/// Whether the values are finite and within the limits of the options. A damage that extends beyond the road has
/// infinite values.
bool is_within_limits(const Damage& damage, const DamageOptions& options) {
  if (damage.pixels == 0) return false;
  if (!damage.metrics) return true;
  const double max_m = damage.kind == DamageKind::depression ? options.max_depth_m : options.max_height_m;
  const double depth_m = damage.metrics->max_depth_m.value;
  const double area_m2 = damage.metrics->area_m2.value;
  return std::isfinite(area_m2) && area_m2 >= options.min_area_m2 && depth_m >= options.min_depth_m && depth_m <= max_m;
}

bool is_resolvable(const Damage& damage) {
  return damage.metrics ? damage.metrics->severity != Severity::unresolvable : damage.evidence.is_depth_resolved();
}

/// Separate damages from candidates, and number the damages by decreasing depth, then the candidates. Returns the new
/// id of each old one in `result.ids`, 0 for those of candidates.
std::vector<std::uint16_t> separate_candidates(const DamageOptions& options, DamageMap& result) {
  std::vector<Damage> measured = std::move(result.damages);
  result.damages.clear();
  result.candidates.clear();
  const std::size_t old_ids = measured.size() + 1;
  std::erase_if(measured, [&](const Damage& damage) { return !is_within_limits(damage, options); });
  add_clutter(measured);
  std::stable_sort(measured.begin(), measured.end(), [](const Damage& one, const Damage& other) {
    return one.max_depth().value > other.max_depth().value;
  });
  std::vector<std::uint16_t> new_id(old_ids, 0);
  for (Damage& damage : measured) {
    const bool is_damage =
        options.min_confidence == 0 || (damage.confidence >= options.min_confidence && is_resolvable(damage));
    if (!is_damage) {
      if (damage.confidence < min_candidate_confidence) continue;
      result.candidates.push_back(damage);
      continue;
    }
    const std::size_t id = result.damages.size() + 1;
    new_id[static_cast<std::size_t>(damage.id)] = static_cast<std::uint16_t>(id);
    damage.id = static_cast<int>(id);
    result.damages.push_back(damage);
  }
  int id = static_cast<int>(result.damages.size());
  for (Damage& candidate : result.candidates) candidate.id = ++id;
  return new_id;
}

}  // namespace

void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    const std::optional<FrameGeometry>& geometry, int threads, DamageMap& result) {
  constexpr int rows_per_band = 32;
  result.damages.assign(segmentation.candidates.size(), {});
  if (!segmentation.candidates.empty()) {
    rasterise(segmentation, result);
    measure_candidates(input, options, segmentation, geometry, threads, result);
  }
  const PixelBox all = box_around(result.damages);
  const std::vector<std::uint16_t> new_id = separate_candidates(options, result);
  parallel_rows(result.ids.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int v = std::max(first, all.v0); v <= std::min(last - 1, all.v1); ++v) {
      std::uint16_t* const ids = result.ids.row(v);
      for (int u = all.u0; u <= all.u1; ++u) {
        if (ids[u] == 0) continue;
        ids[u] = new_id[ids[u]];
        if (ids[u] == 0) empty_pixel(input, segmentation, u, v, result);
      }
    }
    for (int v = first; result.metric && v < last; ++v) {
      geometry->depths_to_metres(v, result.ids.width(), result.surface.row(v), result.depth.row(v));
    }
  });
}

}  // namespace roadstereo

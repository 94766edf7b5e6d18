#include "damage/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "damage/clutter.hpp"
#include "damage/damage_maps.hpp"
#include "damage/distress.hpp"
#include "damage/metric_measurement.hpp"
#include "damage/pixel_measurement.hpp"
#include "damage/searched_range.hpp"
#include "damage/specular_excess.hpp"
#include "damage/texture_share.hpp"

namespace roadstereo {
namespace {

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
    DamageMetrics metrics = compute_metrics(input, options, *geometry, offset, result, damage);
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

/// Measure the shape of candidate `k` inside its rim, which is all that `result` keeps of it, classify and grade it.
void finish_metrics(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    const FrameGeometry& geometry, std::size_t k, const SurfaceOffset& offset, const DamageMap& result,
                    Damage& damage) {
  const Candidate& candidate = segmentation.candidates[k];
  if (ends_at_rim(candidate, damage)) {
    count_pixels(input, result, offset.value, pixel_box(candidate, segmentation.cells), damage);
    if (damage.pixels > 0) keep_inside_rim(input, geometry, offset, result, damage, *damage.metrics);
  }
  DamageMetrics& metrics = *damage.metrics;
  metrics.distress =
      classify_distress(damage, metrics, options.mount_yaw_deg, possible_wall_slope(metrics, damage.pixels),
                        is_at_side(candidate, segmentation.view));
  const bool resolvable = damage.evidence.is_depth_resolved() || metrics.mean_depth_m.is_resolved();
  grade(options.severity, {resolvable, damage.ends_search}, metrics);
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

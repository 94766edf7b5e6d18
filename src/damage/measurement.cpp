#include "damage/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "damage/damage_maps.hpp"
#include "damage/metric_measurement.hpp"

namespace roadstereo {
namespace {

/// Sums over the pixels of one damage. Depths are in pixels of ℓ'.
struct PixelSums {
  Damage damage;
  double u = 0, v = 0, depth = 0;
  std::size_t measured = 0;
};

void add_pixel(const DamageInput& input, const DamageMap& maps, int u, int v, PixelSums& sums) {
  Damage& damage = sums.damage;
  if (damage.pixels == 0) damage.box_px = {u, v, u, v};
  damage.box_px = {std::min(damage.box_px[0], u), std::min(damage.box_px[1], v), std::max(damage.box_px[2], u),
                   std::max(damage.box_px[3], v)};
  ++damage.pixels;
  sums.u += u;
  sums.v += v;
  if (u == 0 || v == 0 || u + 1 == maps.ids.width() || v + 1 == maps.ids.height()) damage.cut_by_border = true;
  if (!std::isfinite(input.transformed(u, v))) return;
  ++sums.measured;
  sums.depth += std::abs(maps.depth(u, v));
}

/// Find the maximum of the smoothed depth cells, which is robust against single wrong pixels.
void find_deepest(const Segmentation& segmentation, const Candidate& candidate, Damage& damage) {
  const float sign = sign_of(candidate.kind);
  float max_depth = 0;
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      const float depth = sign * segmentation.depth_cells.depth(i, j);
      if (!candidate.cells(i, j) || segmentation.depth_cells.valid(i, j) == 0 || depth <= max_depth) continue;
      max_depth = depth;
      // The centre of a cell that the border clips may lie outside the image.
      const Cells& cells = segmentation.cells;
      damage.deepest_px = {std::min(static_cast<int>(cells.middle(i)), cells.image_width - 1),
                           std::min(static_cast<int>(cells.middle(j)), cells.image_height - 1)};
    }
  }
  damage.max_depth_px.value = max_depth;
}

/// Measure candidate `k` in pixels.
Damage measure_in_pixels(const DamageInput& input, const Segmentation& segmentation, std::size_t k,
                         const DamageMap& maps) {
  const Candidate& candidate = segmentation.candidates[k];
  PixelSums sums;
  Damage& damage = sums.damage;
  damage.id = static_cast<int>(k + 1);
  damage.kind = candidate.kind;
  const PixelBox box = pixel_box(candidate, segmentation.cells);
  for (int v = box.v0; v <= box.v1; ++v) {
    for (int u = box.u0; u <= box.u1; ++u) {
      if (maps.ids(u, v) == damage.id) add_pixel(input, maps, u, v, sums);
    }
  }
  if (damage.pixels > 0) {
    const auto pixels = static_cast<double>(damage.pixels);
    damage.centroid_px = {sums.u / pixels, sums.v / pixels};
    damage.measured_share = static_cast<double>(sums.measured) / pixels;
    damage.mean_depth_px = sums.measured > 0 ? sums.depth / static_cast<double>(sums.measured) : 0;
  }
  find_deepest(segmentation, candidate, damage);
  return damage;
}

/// Replace the id of every pixel by `new_id[id]`. `damages` bound the rows to visit.
void relabel(const std::vector<Damage>& damages, const std::vector<std::uint16_t>& new_id, Image<std::uint16_t>& ids) {
  int top = ids.height();
  int bottom = -1;
  for (const Damage& damage : damages) {
    if (damage.pixels == 0) continue;
    top = std::min(top, damage.box_px[1]);
    bottom = std::max(bottom, damage.box_px[3]);
  }
  for (int v = top; v <= bottom; ++v) {
    std::uint16_t* const row = ids.row(v);
    for (int u = 0; u < ids.width(); ++u) row[u] = new_id[row[u]];
  }
}

/// Remove damages shallower than three standard errors of their depth, and those without finite metric values, which
/// extend beyond the road. Number the others by decreasing depth.
void keep_significant(DamageMap& result) {
  constexpr double min_std_errors = 3;
  std::vector<Damage> kept;
  for (const Damage& damage : result.damages) {
    const bool finite =
        !damage.metrics || std::isfinite(damage.metrics->max_depth_m.value + damage.metrics->area_m2.value);
    if (damage.pixels > 0 && finite && damage.max_depth_px.value >= min_std_errors * damage.max_depth_px.std_error) {
      kept.push_back(damage);
    }
  }
  const auto depth_of = [](const Damage& damage) {
    return damage.metrics ? damage.metrics->max_depth_m.value : damage.max_depth_px.value;
  };
  std::stable_sort(kept.begin(), kept.end(),
                   [&](const Damage& one, const Damage& other) { return depth_of(one) > depth_of(other); });
  std::vector<std::uint16_t> new_id(result.damages.size() + 1, 0);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    new_id[static_cast<std::size_t>(kept[k].id)] = static_cast<std::uint16_t>(k + 1);
    kept[k].id = static_cast<int>(k + 1);
  }
  relabel(result.damages, new_id, result.ids);
  result.damages = std::move(kept);
}

}  // namespace

void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& segmentation,
                    int threads, DamageMap& result) {
  fill_maps(input, segmentation, threads, result);
  result.damages.clear();
  std::vector<SurfaceOffset> offsets;
  offsets.reserve(segmentation.candidates.size());
  for (std::size_t k = 0; k < segmentation.candidates.size(); ++k) {
    const SurfaceOffset offset =
        offsets.emplace_back(estimate_surface_offset(segmentation, segmentation.candidates[k]));
    Damage& damage = result.damages.emplace_back(measure_in_pixels(input, segmentation, k, result));
    const auto [u, v] = damage.deepest_px;
    const double sigma_at_deepest = input.sigma.empty() ? result.noise_px : input.sigma(u, v);
    const double sigma = std::isfinite(sigma_at_deepest) ? sigma_at_deepest : result.noise_px;
    damage.max_depth_px.value += sign_of(damage.kind) * offset.value;
    damage.max_depth_px.std_error = std::hypot(sigma, offset.std_error);
  }
  std::optional<FrameGeometry> geometry;
  if (result.metric) geometry.emplace(input);
  if (geometry) measure_in_metres(input, options, *geometry, offsets, result);
  keep_significant(result);
  if (geometry) depth_to_metres(*geometry, threads, result);
}

}  // namespace roadstereo

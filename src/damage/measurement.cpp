#include "damage/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "damage/damage_maps.hpp"
#include "damage/metric_measurement.hpp"

namespace roadstereo {
namespace {

/// Figures in pixels; `depth` of the result is still in pixels.
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

/// The largest depth of the smoothed relief, so that no single wrong pixel decides.
void find_deepest(const Segmentation& found, const Candidate& candidate, Damage& damage) {
  const float sign = sign_of(candidate.kind);
  float largest = 0;
  for (int j = candidate.box.first_row; j <= candidate.box.last_row; ++j) {
    for (int i = candidate.box.first_column; i <= candidate.box.last_column; ++i) {
      const float depth = sign * found.relief.depth(i, j);
      if (candidate.cells(i, j) == 0 || found.relief.known(i, j) == 0 || depth <= largest) continue;
      largest = depth;
      // The middle of a cell that the border cuts may lie outside the picture.
      damage.deepest_px = {std::min(static_cast<int>(found.cells.middle(i)), found.cells.image_width - 1),
                           std::min(static_cast<int>(found.cells.middle(j)), found.cells.image_height - 1)};
    }
  }
  damage.max_depth_px.value = largest;
}

std::vector<Damage> measure_in_pixels(const DamageInput& input, const Segmentation& found, const DamageMap& maps) {
  std::vector<PixelSums> sums(found.candidates.size());
  for (int v = 0; v < maps.ids.height(); ++v) {
    for (int u = 0; u < maps.ids.width(); ++u) {
      const std::uint16_t id = maps.ids(u, v);
      if (id != 0) add_pixel(input, maps, u, v, sums[id - 1U]);
    }
  }
  std::vector<Damage> damages;
  damages.reserve(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    Damage& damage = sums[k].damage;
    damage.id = static_cast<int>(k + 1);
    damage.kind = found.candidates[k].kind;
    if (damage.pixels > 0) {
      const auto pixels = static_cast<double>(damage.pixels);
      damage.centroid_px = {sums[k].u / pixels, sums[k].v / pixels};
      damage.measured_share = static_cast<double>(sums[k].measured) / pixels;
      damage.mean_depth_px = sums[k].measured > 0 ? sums[k].depth / static_cast<double>(sums[k].measured) : 0;
    }
    find_deepest(found, found.candidates[k], damage);
    damages.push_back(damage);
  }
  return damages;
}

/// Drops what is not deeper than its own standard error says it must be, or reaches beyond the road, and numbers the
/// rest anew, deepest first.
void keep_significant(DamageMap& result) {
  constexpr double least_sigmas = 3;
  std::vector<Damage> kept;
  for (const Damage& damage : result.damages) {
    const bool finite =
        !damage.metrics || std::isfinite(damage.metrics->max_depth_m.value + damage.metrics->area_m2.value);
    if (damage.pixels > 0 && finite && damage.max_depth_px.value >= least_sigmas * damage.max_depth_px.std_error) {
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
  for (int v = 0; v < result.ids.height(); ++v) {
    std::uint16_t* row = result.ids.row(v);
    for (int u = 0; u < result.ids.width(); ++u) row[u] = new_id[row[u]];
  }
  result.damages = std::move(kept);
}

}  // namespace

void measure_damage(const DamageInput& input, const DamageOptions& options, const Segmentation& found, int threads,
                    DamageMap& result) {
  paint_maps(input, found, threads, result);
  result.damages = measure_in_pixels(input, found, result);
  std::vector<SurfaceOffset> offsets;
  offsets.reserve(result.damages.size());
  for (std::size_t k = 0; k < result.damages.size(); ++k) {
    const SurfaceOffset offset = offsets.emplace_back(local_surface_offset(found, found.candidates[k]));
    Damage& damage = result.damages[k];
    const auto [u, v] = damage.deepest_px;
    const double own = input.sigma.empty() ? result.noise_px : input.sigma(u, v);
    const double sigma = std::isfinite(own) ? own : result.noise_px;
    damage.max_depth_px.value += sign_of(damage.kind) * offset.value;
    damage.max_depth_px.std_error = std::hypot(sigma, offset.std_error);
  }
  if (result.metric) measure_in_metres(input, options, offsets, result);
  keep_significant(result);
  if (result.metric) depth_to_metres(input, threads, result);
}

}  // namespace roadstereo

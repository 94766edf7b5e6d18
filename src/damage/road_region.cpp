#include "damage/road_region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/binned_selection.hpp"
#include "core/parallel.hpp"
#include "damage/connected_components.hpp"
#include "damage/morphology.hpp"

namespace roadstereo {
namespace {

/// Mark the cells within `max_distance` pixels, or within a relief of `relief_m`, of the road.
void mark_near(const float* measured, const float* road, const float* scale, float max_distance, float relief_m,
               int width, std::uint8_t* near) {
  for (int i = 0; i < width; ++i) {
    near[i] = std::abs(measured[i] - road[i]) <= std::max(max_distance, relief_m * scale[i]) ? 255 : 0;
  }
}

/// Mask of the cells near the surface.
Image<std::uint8_t> cells_near_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                                       const RoadSurface& surface, double relief_m, int threads) {
  constexpr int rows_per_band = 64;
  constexpr double max_sigmas = 3;
  const auto max_distance = static_cast<float>(max_sigmas * surface.noise);
  Image<std::uint8_t> near;
  near.resize(cells.width(), cells.height());
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      mark_near(cells.value.row(j), surface.value.row(j), coordinates.scale.row(j), max_distance,
                static_cast<float>(relief_m), cells.width(), near.row(j));
    }
  });
  return near;
}

/// Mark the cells within a pixel of the surface, as those of a band of errors are.
void mark_band(const float* value, const float* road, int width, std::uint8_t* band) {
  constexpr float max_band_error = 1;  // pixels
  for (int i = 0; i < width; ++i) band[i] = std::abs(value[i] - road[i]) <= max_band_error ? 255 : 0;
}

/// For each column, the rows since the last set cell above, as long as all between lie in a band; `limit` otherwise.
/// `closed`: that number where a gap ends in this row, else 0.
void update_gaps(const std::uint8_t* mask, const std::uint8_t* band, int width, std::uint8_t limit, std::uint8_t* gaps,
                 std::uint8_t* closed) {
  for (int i = 0; i < width; ++i) {
    const std::uint8_t gap = gaps[i], is_set = mask[i];
    const auto longer = static_cast<std::uint8_t>(gap + 1);
    const std::uint8_t after = band[i] != 0 ? std::min(longer, limit) : limit, ended = gap < limit ? gap : 0;
    gaps[i] = after & ~is_set;
    closed[i] = ended & is_set;
  }
}

/// Close gaps of a mask along the columns, of up to `max_gap` cells that all lie within a pixel of the surface. Blocks
/// that straddle two whole-pixel shifts of the rows err by up to a pixel, in bands across the whole road.
Image<std::uint8_t> close_bands(const Image<std::uint8_t>& mask, const Cells& cells, const RoadSurface& surface,
                                int max_gap) {
  const auto limit = static_cast<std::uint8_t>(max_gap + 1);
  Image<std::uint8_t> result = mask;
  const int width = mask.width();
  std::vector<std::uint8_t> gaps(static_cast<std::size_t>(width), limit), closed(gaps.size()), band(gaps.size());
  for (int j = 0; j < mask.height(); ++j) {
    mark_band(cells.value.row(j), surface.value.row(j), width, band.data());
    update_gaps(mask.row(j), band.data(), width, limit, gaps.data(), closed.data());
    for (int i = next_nonzero(closed.data(), 0, width); i < width; i = next_nonzero(closed.data(), i + 1, width)) {
      for (int k = closed[static_cast<std::size_t>(i)]; k > 0; --k) result(i, j - k) = 255;
    }
  }
  return result;
}

/// The component with the most cells; null if there is none.
const ConnectedComponent* largest(const ConnectedComponents& components) {
  const auto most = std::max_element(components.begin(), components.end(),
                                     [](const auto& one, const auto& other) { return one.size < other.size; });
  return most == components.end() ? nullptr : &*most;
}

/// Whether the second largest part of a road may be as much a road as the largest.
bool is_divided(const ConnectedComponents& parts) {
  constexpr std::size_t min_share = 20;  // 1/20 of the largest
  const ConnectedComponent* const most = largest(parts);
  return std::any_of(parts.begin(), parts.end(),
                     [&](const auto& part) { return &part != most && min_share * part.size > most->size; });
}

/// Heights of the cells about the surface, metres.
Image<float> heights_above(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface,
                           int threads) {
  constexpr int rows_per_band = 64;
  Image<float> heights;
  heights.resize(cells.width(), cells.height());
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const float *value = cells.value.row(j), *road = surface.value.row(j), *scale = coordinates.scale.row(j);
      float* const height = heights.row(j);
      for (int i = 0; i < cells.width(); ++i) height[i] = (value[i] - road[i]) / scale[i];
    }
  });
  return heights;
}

/// Median difference of a part's heights in pixels of ℓ' over `reach` cells along the rows: that of noise on a road, of
/// blades and stones beside it.
float roughness(const ConnectedComponent& part, const Cells& cells, const RoadSurface& surface, int reach) {
  std::vector<float> differences;
  for (const CellRun& run : part.runs) {
    const float *value = cells.value.row(run.row), *road = surface.value.row(run.row);
    for (int i = run.first; i + reach <= run.last; i += reach) {
      const float difference = (value[i + reach] - road[i + reach]) - (value[i] - road[i]);
      if (std::isfinite(difference)) differences.push_back(std::abs(difference));
    }
  }
  return differences.empty() ? std::numeric_limits<float>::infinity() : binned_median(differences);
}

/// Clear the parts that are much rougher than the largest one.
void remove_rough_parts(const ConnectedComponents& parts, const Cells& cells, const RoadSurface& surface, int reach,
                        Image<std::uint8_t>& mask) {
  constexpr float max_ratio = 2;
  const ConnectedComponent* const most = largest(parts);
  const float smooth = roughness(*most, cells, surface, reach);
  for (const ConnectedComponent& part : parts) {
    if (&part != most && roughness(part, cells, surface, reach) > max_ratio * smooth) fill_component(part, 0, mask);
  }
}

/// Set the cells of humps, worn strips and hollows across the road: no higher or deeper than these are, level across
/// the road, unlike what lies beside it, and along it without a step over `reach` rows to either side, which is one
/// that is both steep and as high as a kerb. NaN is none.
void add_humps(const Image<float>& heights, const SurfaceCoordinates& coordinates, int reach, int threads,
               Image<std::uint8_t>& mask) {
  constexpr int rows_per_band = 64;
  constexpr float max_height_m = 0.15F, max_slope = 0.25F, kerb_m = 0.025F;
  constexpr float half_width_m = 0.15F, max_cross_slope = 0.1F;
  if (mask.width() < 2) return;
  const auto rise = [&](int i, int j, int x, int y) { return std::abs(heights(x, y) - heights(i, j)); };
  const auto way = [&](int i, int j, int x, int y) {
    const float dx = coordinates.x(x, y) - coordinates.x(i, j), dy = coordinates.y(x, y) - coordinates.y(i, j);
    return std::sqrt(dx * dx + dy * dy);
  };
  parallel_rows(mask.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const int above = std::max(0, j - reach), below = std::min(mask.height() - 1, j + reach);
      for (int i = 0; i < mask.width(); ++i) {
        if (mask(i, j) != 0 || !(std::abs(heights(i, j)) <= max_height_m)) continue;
        const float cell_m = way(i, j, i > 0 ? i - 1 : i + 1, j);
        if (!(cell_m > 0)) continue;
        const auto widest = static_cast<float>(mask.width());
        const int across = std::max(reach, static_cast<int>(std::min(half_width_m / cell_m, widest)));
        const int left = std::max(0, i - across), right = std::min(mask.width() - 1, i + across);
        if (!(rise(left, j, right, j) <= max_cross_slope * way(left, j, right, j))) continue;
        const float along = rise(i, above, i, below);
        if (along < kerb_m || along <= max_slope * way(i, above, i, below)) mask(i, j) = 255;
      }
    }
  });
}

}  // namespace

Image<std::uint8_t> find_road_region(const Cells& cells, const SurfaceCoordinates& coordinates,
                                     const RoadSurface& surface, const Ruts& ruts, double relief_m, int threads) {
  constexpr int opening_radius = 2;  // cells; connections of up to twice this width are cut
  constexpr std::size_t max_speck_cells = 30;
  constexpr int block_px = 11;  // height of the blocks of `paper`
  Image<std::uint8_t> road = cells_near_surface(cells, coordinates, surface, relief_m, threads);
  fill_holes(road, max_speck_cells);
  Image<std::uint8_t> connected = road;
  ruts.fill(255, connected);
  Image<std::uint8_t> closed = close_bands(connected, cells, surface, block_px / cells.factor);
  ConnectedComponents parts(erode(closed, opening_radius, threads));
  if (coordinates.is_metric && is_divided(parts)) {
    constexpr int step_px = 4;  // a step is smoothed over the support window
    const int reach = std::max(1, step_px / cells.factor);
    add_humps(heights_above(cells, coordinates, surface, threads), coordinates, reach, threads, closed);
    Image<std::uint8_t> joined = erode(closed, opening_radius, threads);
    remove_rough_parts(parts, cells, surface, 2 * reach, joined);
    parts = ConnectedComponents(joined);
  }
  Image<std::uint8_t> core(cells.width(), cells.height(), 0);
  if (const ConnectedComponent* const most = largest(parts)) fill_component(*most, 255, core);
  const Image<std::uint8_t> region = dilate(core, opening_radius + 1, threads);
  const std::uint8_t* const inside = region.row(0);
  std::uint8_t* const row = road.row(0);
  const std::size_t count = road.pixels();
  for (std::size_t k = 0; k < count; ++k) row[k] &= inside[k];
  return road;
}

}  // namespace roadstereo

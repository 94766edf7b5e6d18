#include "damage/road_region.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

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
  Image<std::uint8_t> near(cells.width(), cells.height());
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      mark_near(cells.value.row(j), surface.value.row(j), coordinates.scale.row(j), max_distance,
                static_cast<float>(relief_m), cells.width(), near.row(j));
    }
  });
  return near;
}

/// Of the cells of a row, how many rows lie between each and the last cell above that is set: all of them within a
/// pixel of the surface, `limit` rows at most, else `limit`. `closed`: that number where a gap ends in this row, else
/// 0. Returns whether any does.
bool update_gaps(const std::uint8_t* mask, const float* value, const float* road, int width, std::uint8_t limit,
                 std::uint8_t* gaps, std::uint8_t* closed) {
  constexpr float max_band_error = 1;  // pixels
  std::uint8_t any = 0;
  for (int i = 0; i < width; ++i) {
    const std::uint8_t gap = gaps[i], is_set = mask[i];
    const std::uint8_t ends = is_set != 0 && gap < limit ? gap : std::uint8_t{0};
    const bool continues = std::abs(value[i] - road[i]) <= max_band_error && gap < limit;
    const auto longer = static_cast<std::uint8_t>(gap + 1);
    gaps[i] = is_set != 0 ? std::uint8_t{0} : continues ? longer : limit;
    closed[i] = ends;
    any |= ends;
  }
  return any != 0;
}

/// Close gaps of a mask along the columns, of up to `max_gap` cells that all lie within a pixel of the surface. Blocks
/// that straddle two whole-pixel shifts of the rows err by up to a pixel, in bands across the whole road.
Image<std::uint8_t> close_bands(const Image<std::uint8_t>& mask, const Cells& cells, const RoadSurface& surface,
                                int max_gap) {
  const auto limit = static_cast<std::uint8_t>(max_gap + 1);
  Image<std::uint8_t> result = mask;
  std::vector<std::uint8_t> gaps(static_cast<std::size_t>(mask.width()), limit), closed(gaps.size());
  for (int j = 0; j < mask.height(); ++j) {
    if (!update_gaps(mask.row(j), cells.value.row(j), surface.value.row(j), mask.width(), limit, gaps.data(),
                     closed.data())) {
      continue;
    }
    for (int i = 0; i < mask.width(); ++i) {
      for (int k = closed[static_cast<std::size_t>(i)]; k > 0; --k) result(i, j - k) = 255;
    }
  }
  return result;
}

/// Largest connected component of a mask.
Image<std::uint8_t> largest_component(const Image<std::uint8_t>& mask) {
  const ConnectedComponents components(mask);
  Image<std::uint8_t> result(mask.width(), mask.height(), 0);
  const auto largest = std::max_element(components.begin(), components.end(),
                                        [](const auto& one, const auto& other) { return one.size < other.size; });
  if (largest != components.end()) fill_component(*largest, 255, result);
  return result;
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
  const Image<std::uint8_t> closed = close_bands(connected, cells, surface, block_px / cells.factor);
  const Image<std::uint8_t> region =
      dilate(largest_component(erode(closed, opening_radius, threads)), opening_radius + 1, threads);
  const std::uint8_t* const inside = region.row(0);
  std::uint8_t* const row = road.row(0);
  const std::size_t count = road.pixels();
  for (std::size_t k = 0; k < count; ++k) row[k] &= inside[k];
  return road;
}

}  // namespace roadstereo

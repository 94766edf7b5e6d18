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

/// Close gaps of a mask along the columns, of up to `max_gap` cells that all lie within a pixel of the surface. Blocks
/// that straddle two whole-pixel shifts of the rows err by up to a pixel, in bands across the whole road.
Image<std::uint8_t> close_bands(const Image<std::uint8_t>& mask, const Cells& cells, const RoadSurface& surface,
                                int max_gap) {
  constexpr float max_band_error = 1;  // pixels
  Image<std::uint8_t> closed(mask.width(), mask.height());
  std::vector<int> gap(static_cast<std::size_t>(mask.width()), max_gap + 1);  // cells since the last cell set
  for (int j = 0; j < mask.height(); ++j) {
    const float *const value = cells.value.row(j), *const road = surface.value.row(j);
    for (int i = 0; i < mask.width(); ++i) {
      int& length = gap[static_cast<std::size_t>(i)];
      closed(i, j) = mask(i, j);
      if (mask(i, j) == 0) {
        const bool is_near = std::abs(value[i] - road[i]) <= max_band_error;
        length = is_near && length <= max_gap ? length + 1 : max_gap + 1;
      } else {
        for (int k = 1; k <= length && length <= max_gap; ++k) closed(i, j - k) = 255;
        length = 0;
      }
    }
  }
  return closed;
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
                                     const RoadSurface& surface, double relief_m, int threads) {
  constexpr int opening_radius = 2;  // cells; connections of up to twice this width are cut
  constexpr std::size_t max_speck_cells = 30;
  constexpr int block_px = 11;  // height of the blocks of `paper`
  Image<std::uint8_t> road = cells_near_surface(cells, coordinates, surface, relief_m, threads);
  fill_holes(road, max_speck_cells);
  const Image<std::uint8_t> closed = close_bands(road, cells, surface, block_px / cells.factor);
  const Image<std::uint8_t> region =
      dilate(largest_component(erode(closed, opening_radius, threads)), opening_radius + 1, threads);
  const std::uint8_t* const inside = region.row(0);
  std::uint8_t* const row = road.row(0);
  const std::size_t count = road.pixels();
  for (std::size_t k = 0; k < count; ++k) row[k] &= inside[k];
  return road;
}

}  // namespace roadstereo

#include "damage/road_region.hpp"

#include <algorithm>
#include <cmath>

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
  Image<std::uint8_t> road = cells_near_surface(cells, coordinates, surface, relief_m, threads);
  fill_holes(road, max_speck_cells);
  const Image<std::uint8_t> region =
      dilate(largest_component(erode(road, opening_radius, threads)), opening_radius + 1, threads);
  const std::uint8_t* const inside = region.row(0);
  std::uint8_t* const row = road.row(0);
  const std::size_t count = road.pixels();
  for (std::size_t k = 0; k < count; ++k) row[k] &= inside[k];
  return road;
}

}  // namespace roadstereo

#include "damage/road_region.hpp"

#include <algorithm>
#include <cmath>

#include "damage/connected_regions.hpp"
#include "damage/grow.hpp"

namespace roadstereo {
namespace {

Image<std::uint8_t> near_surface(const Cells& cells, const RoadSurface& surface) {
  constexpr double reach = 3;  // standard deviations of the road
  const auto most = static_cast<float>(reach * surface.noise);
  const int width = cells.width();
  Image<std::uint8_t> near(width, cells.height());
  for (int j = 0; j < cells.height(); ++j) {
    const float* const seen = cells.value.row(j);
    const float* const road = surface.value.row(j);
    std::uint8_t* const row = near.row(j);
    for (int i = 0; i < width; ++i) row[i] = std::abs(seen[i] - road[i]) <= most ? 255 : 0;
  }
  return near;
}

/// The largest part of a mask that hangs together.
Image<std::uint8_t> largest_part(const Image<std::uint8_t>& mask) {
  const ConnectedRegions regions(mask);
  Image<std::uint8_t> part(mask.width(), mask.height(), 0);
  const auto largest = std::max_element(regions.begin(), regions.end(),
                                        [](const auto& one, const auto& other) { return one.size < other.size; });
  if (largest != regions.end()) paint(*largest, 255, part);
  return part;
}

}  // namespace

Image<std::uint8_t> find_road_region(const Cells& cells, const RoadSurface& surface) {
  constexpr int bridge = 2;  // cells; narrower connections are none
  constexpr std::size_t speck = 30;
  Image<std::uint8_t> near = near_surface(cells, surface);
  fill_enclosed(near, speck);
  const Image<std::uint8_t> region = grow(largest_part(shrink_mask(near, bridge)), bridge + 1);
  const std::uint8_t* const within = region.row(0);
  std::uint8_t* const road = near.row(0);
  const std::size_t count = near.pixels();
  for (std::size_t k = 0; k < count; ++k) road[k] &= within[k];
  return near;
}

}  // namespace roadstereo

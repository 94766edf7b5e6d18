#include "damage/road_region.hpp"

#include <algorithm>
#include <cmath>

#include "damage/connected_regions.hpp"

namespace roadstereo {
namespace {

Image<std::uint8_t> near_surface(const Cells& cells, const RoadSurface& surface) {
  constexpr double reach = 3;  // standard deviations of the road
  const auto most = static_cast<float>(reach * surface.noise);
  Image<std::uint8_t> near(cells.width(), cells.height());
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      near(i, j) = std::abs(cells.value(i, j) - surface.value(i, j)) <= most ? 255 : 0;
    }
  }
  return near;
}

/// The largest part of a mask that hangs together.
Image<std::uint8_t> largest_part(const Image<std::uint8_t>& mask) {
  const std::vector<ConnectedRegion> regions = connected_regions(mask);
  Image<std::uint8_t> part(mask.width(), mask.height(), 0);
  if (regions.empty()) return part;
  const auto& largest = *std::max_element(regions.begin(), regions.end(), [](const auto& one, const auto& other) {
    return one.cells.size() < other.cells.size();
  });
  for (const std::int32_t cell : largest.cells) part(cell % mask.width(), cell / mask.width()) = 255;
  return part;
}

}  // namespace

Image<std::uint8_t> find_road_region(const Cells& cells, const RoadSurface& surface) {
  constexpr int bridge = 2;  // cells; narrower connections are none
  constexpr std::size_t speck = 30;
  Image<std::uint8_t> near = near_surface(cells, surface);
  fill_enclosed(near, whole(near), speck);
  Image<std::uint8_t> region = grow(largest_part(shrink_mask(near, bridge, whole(near))), bridge + 1, whole(near));
  for (int j = 0; j < region.height(); ++j) {
    for (int i = 0; i < region.width(); ++i) {
      if (near(i, j) == 0) region(i, j) = 0;
    }
  }
  return region;
}

}  // namespace roadstereo

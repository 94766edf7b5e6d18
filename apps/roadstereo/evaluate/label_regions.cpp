#include "evaluate/label_regions.hpp"

#include <algorithm>
#include <array>

namespace roadstereo::cli {
namespace {

using Pixel = std::array<int, 2>;

/// Pixels of the component that contains `start`, which are labelled with `id`.
std::vector<Pixel> flood_fill(const Image<std::uint8_t>& label, Pixel start, int id, Image<int>& ids) {
  std::vector<Pixel> region{start};
  ids(start[0], start[1]) = id;
  for (std::size_t next = 0; next < region.size(); ++next) {
    const auto [u, v] = region[next];
    for (int row = std::max(0, v - 1); row <= std::min(label.height() - 1, v + 1); ++row) {
      for (int column = std::max(0, u - 1); column <= std::min(label.width() - 1, u + 1); ++column) {
        if (label(column, row) == 0 || ids(column, row) != 0) continue;
        ids(column, row) = id;
        region.push_back({column, row});
      }
    }
  }
  return region;
}

}  // namespace

LabelRegions label_regions(const Image<std::uint8_t>& label) {
  constexpr std::size_t min_pixels = 50;
  constexpr int ignored = -1;
  LabelRegions regions;
  regions.ids.assign(label.width(), label.height(), 0);
  for (int v = 0; v < label.height(); ++v) {
    for (int u = 0; u < label.width(); ++u) {
      if (label(u, v) == 0 || regions.ids(u, v) != 0) continue;
      const std::vector<Pixel> region =
          flood_fill(label, {u, v}, static_cast<int>(regions.sizes.size()) + 1, regions.ids);
      if (region.size() >= min_pixels) {
        regions.sizes.push_back(region.size());
        continue;
      }
      for (const auto& [column, row] : region) regions.ids(column, row) = ignored;
    }
  }
  for (int v = 0; v < label.height(); ++v) {
    int* row = regions.ids.row(v);
    std::replace(row, row + label.width(), ignored, 0);
  }
  return regions;
}

}  // namespace roadstereo::cli

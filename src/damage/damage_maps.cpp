#include "damage/damage_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int rows_per_band = 16;

float sign_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1.0F : -1.0F;
}

enum class Place { outside, rim, inside };

Place place_of(const Image<std::uint8_t>& region, int i, int j) {
  int set = 0;
  int near = 0;
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const int column = std::clamp(i + di, 0, region.width() - 1);
      const int row = std::clamp(j + dj, 0, region.height() - 1);
      near += region(column, row) != 0 ? 1 : 0;
      set += (di == 0 || dj == 0) && region(column, row) != 0 ? 1 : 0;
    }
  }
  constexpr int cross = 5;
  if (set == cross) return Place::inside;
  return near > 0 ? Place::rim : Place::outside;
}

/// The outline between the cells is where the interpolated depth passes the level.
void paint_candidate(const Segmentation& found, const Candidate& candidate, std::uint16_t id,
                     Image<std::uint16_t>& ids) {
  const int factor = found.cells.factor;
  const Box box = candidate.box.grown(1, found.cells.width(), found.cells.height());
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      const Place place = place_of(candidate.cells, i, j);
      if (place == Place::outside) continue;
      for (int v = j * factor; v < std::min((j + 1) * factor, ids.height()); ++v) {
        for (int u = i * factor; u < std::min((i + 1) * factor, ids.width()); ++u) {
          const bool deep = factor == 1 ? candidate.cells(i, j) != 0 : candidate.cells(i, j) != 0;
          if ((place == Place::inside || deep) && ids(u, v) == 0) ids(u, v) = id;
        }
      }
    }
  }
}

/// DepthCells with the islands and gaps inside the damages replaced by what surrounds them.
Image<float> relief_without_islands(const Segmentation& found) {
  Image<float> depth = found.relief.depth;
  Image<std::uint8_t> known = found.relief.known;
  for (const Candidate& candidate : found.candidates) {
    const float sign = sign_of(candidate.kind);
    const Image<std::uint8_t> interior = shrink_mask(candidate.cells, 2);
    for (int j = candidate.box.first_row; j <= candidate.box.last_row; ++j) {
      for (int i = candidate.box.first_column; i <= candidate.box.last_column; ++i) {
        if (interior(i, j) != 0 && sign * depth(i, j) < candidate.level) known(i, j) = 0;
      }
    }
  }
  interpolate_gaps(depth, known);
  return depth;
}

}  // namespace

void paint_maps(const DamageInput& input, const Segmentation& found, int threads, DamageMap& result) {
  const auto& transformed = input.transformed;
  const int width = transformed.width();
  const int height = transformed.height();
  const int factor = found.cells.factor;
  result.ids.assign(width, height, 0);
  result.road.assign(width, height, 0);
  result.surface.assign(width, height, nan);
  result.depth.assign(width, height, nan);
  for (std::size_t k = 0; k < found.candidates.size(); ++k) {
    paint_candidate(found, found.candidates[k], static_cast<std::uint16_t>(k + 1), result.ids);
  }
  const Image<float> relief = relief_without_islands(found);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) {
        const std::uint16_t id = result.ids(u, v);
        result.road(u, v) = id != 0 || found.road(u / factor, v / factor) != 0 ? 255 : 0;
        const float surface = at_pixel(found.surface.value, factor, u, v);
        result.surface(u, v) = surface;
        float depth = surface - transformed(u, v);
        if (id != 0) {
          const Candidate& candidate = found.candidates[id - 1U];
          const float inside = at_pixel(relief, factor, u, v);
          const float sign = sign_of(candidate.kind);
          const bool island = sign * depth < candidate.level && sign * inside > candidate.level;
          if (std::isnan(depth) || island) depth = inside;
        }
        result.depth(u, v) = depth;
      }
    }
  });
}

}  // namespace roadstereo

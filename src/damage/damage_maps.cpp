#include "damage/damage_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int rows_per_band = 16;

/// The region's cells within a box, 1 inside and 0 outside.
Image<float> indicator_of(const Image<std::uint8_t>& region, const Box& box) {
  Image<float> indicator(box.last_column - box.first_column + 1, box.last_row - box.first_row + 1);
  for (int j = 0; j < indicator.height(); ++j) {
    for (int i = 0; i < indicator.width(); ++i) {
      indicator(i, j) = region(box.first_column + i, box.first_row + j) != 0 ? 1.0F : 0.0F;
    }
  }
  return indicator;
}

/// The outline runs where the cells, interpolated, are half inside.
void paint_candidate(const Cells& cells, const Candidate& candidate, std::uint16_t id, Image<std::uint16_t>& ids) {
  const int factor = cells.factor;
  const Box box = candidate.box.grown(1, cells.width(), cells.height());
  const Image<float> inside = indicator_of(candidate.cells, box);
  const int first_u = box.first_column * factor;
  const int first_v = box.first_row * factor;
  const int end_u = std::min((box.last_column + 1) * factor, ids.width());
  const int end_v = std::min((box.last_row + 1) * factor, ids.height());
  for (int v = first_v; v < end_v; ++v) {
    for (int u = first_u; u < end_u; ++u) {
      if (ids(u, v) == 0 && at_pixel(inside, factor, u - first_u, v - first_v) > 0.5F) ids(u, v) = id;
    }
  }
}

/// Depths in which the gaps and islands inside the damages are replaced by what surrounds them.
Image<float> relief_without_islands(const Segmentation& found) {
  Image<float> depth = found.relief.depth;
  Image<std::uint8_t> known = found.relief.known;
  for (const Candidate& candidate : found.candidates) {
    const float sign = sign_of(candidate.kind);
    const Image<std::uint8_t> interior =
        shrink_mask(candidate.cells, 2, candidate.box.grown(1, depth.width(), depth.height()));
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
    paint_candidate(found.cells, found.candidates[k], static_cast<std::uint16_t>(k + 1), result.ids);
  }
  const Image<float> relief = relief_without_islands(found);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) {
        const std::uint16_t id = result.ids(u, v);
        result.road(u, v) = id != 0 || found.road(u / factor, v / factor) != 0 ? 255 : 0;
        const float surface = at_pixel(found.surface.value, factor, u, v);
        result.surface(u, v) = surface;
        float depth = std::isfinite(transformed(u, v)) ? surface - transformed(u, v) : nan;
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

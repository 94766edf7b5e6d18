#include "damage/damage_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "damage/cell_interpolation.hpp"
#include "damage/grow.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int rows_per_band = 16;

/// The cells of a box, 1 inside the region and 0 outside.
Image<float> indicator_of(const BoxMask& region, const Box& box) {
  Image<float> indicator(box.columns(), box.rows());
  for (int j = 0; j < indicator.height(); ++j) {
    for (int i = 0; i < indicator.width(); ++i) {
      indicator(i, j) = region(box.first_column + i, box.first_row + j) ? 1.0F : 0.0F;
    }
  }
  return indicator;
}

/// A cell more on each side: there the interpolated cells may still be half inside.
Box box_around(const Candidate& candidate, const Cells& cells) {
  return candidate.box().grown(1, cells.width(), cells.height());
}

/// The outline runs where the cells, interpolated, are half inside.
void paint_candidate(const Cells& cells, const Candidate& candidate, std::uint16_t id, Image<std::uint16_t>& ids) {
  const Image<float> inside = indicator_of(candidate.cells, box_around(candidate, cells));
  const PixelBox box = pixels_of(candidate, cells);
  PixelRows rows(inside, cells.factor, box.width());
  std::vector<float> share(static_cast<std::size_t>(box.width()));
  for (int v = box.v0; v <= box.v1; ++v) {
    rows.read(v - box.v0, share.data());
    std::uint16_t* const row = ids.row(v) + box.u0;
    for (std::size_t k = 0; k < share.size(); ++k) {
      if (row[k] == 0 && share[k] > 0.5F) row[k] = id;
    }
  }
}

/// Depths in which the gaps and islands inside the damages are replaced by what surrounds them.
Image<float> relief_without_islands(const Segmentation& found) {
  Image<float> depth = found.relief.depth;
  Image<std::uint8_t> known = found.relief.known;
  bool any = false;
  for (const Candidate& candidate : found.candidates) {
    const float sign = sign_of(candidate.kind);
    const BoxMask interior = shrink_mask(candidate.cells, 2, box_around(candidate, found.cells));
    const Box& box = candidate.box();
    for (int j = box.first_row; j <= box.last_row; ++j) {
      for (int i = box.first_column; i <= box.last_column; ++i) {
        if (!interior(i, j) || sign * depth(i, j) >= candidate.level) continue;
        any |= known(i, j) != 0;
        known(i, j) = 0;
      }
    }
  }
  if (any) interpolate_gaps(depth, known);
  return depth;
}

/// Writes the cells of a row as pixels.
void spread_row(const std::uint8_t* cells, int factor, int width, std::uint8_t* pixels) {
  for (int i = 0, u = 0; u < width; ++i) {
    for (const int end = std::min(u + factor, width); u < end; ++u) pixels[u] = cells[i];
  }
}

/// Road, surface and depth as they are without any damage.
void paint_road(const DamageInput& input, const Segmentation& found, int threads, DamageMap& result) {
  const int width = input.transformed.width();
  const int factor = found.cells.factor;
  constexpr float largest = std::numeric_limits<float>::max();
  parallel_rows(input.transformed.height(), rows_per_band, threads, [&](int first, int last, int) {
    PixelRows surfaces(found.surface.value, factor, width);
    for (int v = first; v < last; ++v) {
      if (v == first || v % factor == 0) {
        spread_row(found.road.row(v / factor), factor, width, result.road.row(v));
      } else {
        std::copy_n(result.road.row(v - 1), width, result.road.row(v));
      }
      const float* const seen = input.transformed.row(v);
      float* const surface = result.surface.row(v);
      float* const depth = result.depth.row(v);
      surfaces.read(v, surface);
      for (int u = 0; u < width; ++u) {
        const float below = surface[u] - seen[u];
        depth[u] = std::abs(seen[u]) <= largest ? below : nan;
      }
    }
  });
}

/// A damage is part of the road; its gaps and islands are as deep as what surrounds them.
void paint_inside(const Candidate& candidate, std::uint16_t id, const Cells& cells, const Image<float>& relief,
                  DamageMap& result) {
  const float sign = sign_of(candidate.kind);
  const PixelBox box = pixels_of(candidate, cells);
  for (int v = box.v0; v <= box.v1; ++v) {
    for (int u = box.u0; u <= box.u1; ++u) {
      if (result.ids(u, v) != id) continue;
      result.road(u, v) = 255;
      float& depth = result.depth(u, v);
      if (sign * depth >= candidate.level) continue;
      const float inside = at_pixel(relief, cells.factor, u, v);
      if (std::isnan(depth) || sign * inside > candidate.level) depth = inside;
    }
  }
}

}  // namespace

PixelBox pixels_of(const Candidate& candidate, const Cells& cells) {
  const Box box = box_around(candidate, cells);
  return {box.first_column * cells.factor, box.first_row * cells.factor,
          std::min((box.last_column + 1) * cells.factor, cells.image_width) - 1,
          std::min((box.last_row + 1) * cells.factor, cells.image_height) - 1};
}

void paint_maps(const DamageInput& input, const Segmentation& found, int threads, DamageMap& result) {
  const int width = input.transformed.width();
  const int height = input.transformed.height();
  result.ids.assign(width, height, 0);
  result.road.resize(width, height);
  result.surface.resize(width, height);
  result.depth.resize(width, height);
  paint_road(input, found, threads, result);
  if (found.candidates.empty()) return;
  const Image<float> relief = relief_without_islands(found);
  for (std::size_t k = 0; k < found.candidates.size(); ++k) {
    const auto id = static_cast<std::uint16_t>(k + 1);
    paint_candidate(found.cells, found.candidates[k], id, result.ids);
    paint_inside(found.candidates[k], id, found.cells, relief, result);
  }
}

}  // namespace roadstereo

#include "damage/damage_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "damage/cell_interpolation.hpp"
#include "damage/morphology.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Indicator function of a region on the cells of a box: 1 inside, 0 outside.
Image<float> indicator_of(const BoxMask& region, const CellBox& box) {
  Image<float> indicator(box.columns(), box.rows());
  for (int j = 0; j < indicator.height(); ++j) {
    for (int i = 0; i < indicator.width(); ++i) {
      indicator(i, j) = region(box.first_column + i, box.first_row + j) ? 1.0F : 0.0F;
    }
  }
  return indicator;
}

/// Bounding box with a margin of one cell, in which the interpolated indicator may exceed 0.5.
CellBox padded_box(const Candidate& candidate, const Cells& cells) {
  return candidate.box().grown(1, cells.width(), cells.height());
}

/// Rasterise cells of a candidate at full resolution: `visit(u, v, inside)` for every pixel of its box, inside where
/// the interpolated indicator exceeds 0.5.
template <class Visit>
void rasterise(const Cells& cells, const Candidate& candidate, const BoxMask& region, const Visit& visit) {
  const Image<float> indicator = indicator_of(region, padded_box(candidate, cells));
  const PixelBox box = pixel_box(candidate, cells);
  RowUpsampler rows(indicator, cells.factor, box.width());
  std::vector<float> values(static_cast<std::size_t>(box.width()));
  for (int v = box.v0; v <= box.v1; ++v) {
    rows.read(v - box.v0, values.data());
    for (int u = box.u0; u <= box.u1; ++u) visit(u, v, values[static_cast<std::size_t>(u - box.u0)] > 0.5F);
  }
}

/// Depth of the measured value below the surface, pixels of ℓ'; NaN in a hole.
float measured_depth(float surface, float measured) {
  return std::abs(measured) <= max_map_value ? surface - measured : nan;
}

/// Upsample a row of cells by replication.
void replicate_row(const std::uint8_t* cells, int factor, int width, std::uint8_t* pixels) {
  const int whole = width / factor;
  for (int k = 0; k < factor; ++k) {
    for (int i = 0; i < whole; ++i) pixels[i * factor + k] = cells[i];
  }
  for (int u = whole * factor; u < width; ++u) pixels[u] = cells[whole];
}

}  // namespace

PixelBox pixel_box(const Candidate& candidate, const Cells& cells) {
  const CellBox box = padded_box(candidate, cells);
  return {box.first_column * cells.factor, box.first_row * cells.factor,
          std::min((box.last_column + 1) * cells.factor, cells.image_width) - 1,
          std::min((box.last_row + 1) * cells.factor, cells.image_height) - 1};
}

void resize_maps(int width, int height, DamageMap& result) {
  result.ids.resize(width, height);
  result.road.resize(width, height);
  result.surface.resize(width, height);
  result.depth.resize(width, height);
}

void fill_road_rows(const DamageInput& input, const Segmentation& segmentation, int first, int last,
                    DamageMap& result) {
  const int width = input.transformed.width();
  const int factor = segmentation.cells.factor;
  RowUpsampler surfaces(segmentation.surface.value, factor, width);
  for (int v = first; v < last; ++v) {
    std::fill_n(result.ids.row(v), width, std::uint16_t{0});
    if (v == first || v % factor == 0) {
      replicate_row(segmentation.road.row(v / factor), factor, width, result.road.row(v));
    } else {
      std::copy_n(result.road.row(v - 1), width, result.road.row(v));
    }
    const float* const measured = input.transformed.row(v);
    float* const surface = result.surface.row(v);
    float* const depth = result.depth.row(v);
    surfaces.read(v, surface);
    for (int u = 0; u < width; ++u) depth[u] = measured_depth(surface[u], measured[u]);
    std::fill_n(depth, std::min(width, segmentation.view.first_column(v / factor) * factor), nan);
  }
}

Image<float> depth_without_islands(const Segmentation& segmentation, int threads) {
  Image<float> depth = segmentation.depth_cells.depth;
  Image<std::uint8_t> valid = segmentation.depth_cells.valid;
  bool has_islands = false;
  for (const Candidate& candidate : segmentation.candidates) {
    const float sign = sign_of(candidate.kind);
    const BoxMask interior = erode(candidate.cells, 2, padded_box(candidate, segmentation.cells));
    const CellBox& box = candidate.box();
    for (int j = box.first_row; j <= box.last_row; ++j) {
      for (int i = box.first_column; i <= box.last_column; ++i) {
        if (!interior(i, j) || sign * depth(i, j) >= candidate.level) continue;
        has_islands |= valid(i, j) != 0;
        valid(i, j) = 0;
      }
    }
  }
  if (has_islands) fill_gaps(depth, valid, threads);
  return depth;
}

void rasterise(const Segmentation& segmentation, DamageMap& result) {
  for (std::size_t k = 0; k < segmentation.candidates.size(); ++k) {
    const Candidate& candidate = segmentation.candidates[k];
    rasterise(segmentation.cells, candidate, candidate.cells, [&](int u, int v, bool inside) {
      std::uint16_t& id = result.ids(u, v);
      // There is no surface beside the last cells of the road.
      if (inside && id == 0 && !std::isnan(result.surface(u, v))) id = static_cast<std::uint16_t>(k + 1);
    });
  }
}

void empty_beyond_rim(const DamageInput& input, const Segmentation& segmentation, std::size_t k, DamageMap& result) {
  const Candidate& candidate = segmentation.candidates[k];
  rasterise(segmentation.cells, candidate, candidate.inside, [&](int u, int v, bool inside) {
    if (!inside && result.ids(u, v) == k + 1) empty_pixel(input, segmentation, u, v, result);
  });
}

void fill_damage(const Segmentation& segmentation, std::size_t k, const Image<float>& interpolated, DamageMap& result) {
  const Candidate& candidate = segmentation.candidates[k];
  const auto id = static_cast<std::uint16_t>(k + 1);
  const Cells& cells = segmentation.cells;
  const float sign = sign_of(candidate.kind);
  const PixelBox box = pixel_box(candidate, cells);
  for (int v = box.v0; v <= box.v1; ++v) {
    const LinearTaps rows = linear_taps(v, cells.factor, interpolated.height());
    for (int u = box.u0; u <= box.u1; ++u) {
      if (result.ids(u, v) != id) continue;
      result.road(u, v) = 255;
      float& depth = result.depth(u, v);
      const bool is_gap = segmentation.depth_cells.valid(u / cells.factor, v / cells.factor) == 0;
      if (sign * depth >= candidate.level && !is_gap) continue;
      const float inside = interpolate_bilinear(interpolated, cells.factor, u, rows);
      if (std::isnan(depth) || is_gap || sign * inside > candidate.level) depth = inside;
    }
  }
}

void empty_pixel(const DamageInput& input, const Segmentation& segmentation, int u, int v, DamageMap& result) {
  const int factor = segmentation.cells.factor;
  result.ids(u, v) = 0;
  result.road(u, v) = segmentation.road(u / factor, v / factor);
  const bool seen = u >= segmentation.view.first_column(v / factor) * factor;
  result.depth(u, v) = seen ? measured_depth(result.surface(u, v), input.transformed(u, v)) : nan;
}

}  // namespace roadstereo

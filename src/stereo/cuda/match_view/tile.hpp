#pragma once

#include "core/cuda/warp.hpp"
#include "stereo/cuda/match_view.hpp"

// Tile of a block of threads with the halo of window and blocks. The drawing is in stereo/cpu/match_view.hpp.

namespace roadstereo::cuda {

inline constexpr int tile_columns = 32;
inline constexpr int tile_rows = 8;
inline constexpr int threads = tile_columns * tile_rows;
inline constexpr int chunk = 4;  // disparities at a time

/// The same for all tiles of a launch: a parameter of the kernel, which takes no registers from the weights.
struct Halo {
  int step;             ///< pixels from one column or row to the next
  int columns, rows;    ///< of a tile with the window's taps
  int product_columns;  ///< pixels across, with the blocks' radius on both sides
  int cost_columns;     ///< from one row of costs to the next: `columns`, or as the products, whose memory they take
};

/// Where the tile and its halo lie, in the view's own coordinates. Columns and rows of both are matched pixels.
struct Tile {
  Halo halo;
  int first_i, columns;  ///< the tile itself
  int first_v;
  int halo_i, halo_v;  ///< with the window's taps
  SearchRange range;
};

__device__ inline int image_column(const ViewToMatch& view, int i) {
  return view.mirrored ? view.own.width() - 1 - i : i;
}
/// Own pixel i of row v sees the other view from disparity 0 to i − first_visible(v).
__device__ inline int first_visible(const ViewToMatch& view, int v) {
  return view.mirrored ? 0 : __ldg(view.first_column + v);
}
__device__ inline int last_valid(const ViewToMatch& view, int v) {
  return view.mirrored ? view.own.width() - 1 - __ldg(view.first_column + v) : view.own.width() - 1;
}

/// Tiles along a side of `pixels` pixels, for tiles of `size` matched ones.
ROADSTEREO_HD inline int tiles_along(int pixels, const ViewSettings& settings, int size) {
  const int matched = (pixels + settings.pixel_step - 1) / settings.pixel_step;
  return (matched + size - 1) / size;
}

/// Tiles of a view.
ROADSTEREO_HD inline int tiles_of(int width, int height, const ViewSettings& settings) {
  return tiles_along(width, settings, tile_columns) * tiles_along(height, settings, tile_rows);
}

/// `costs_apart`: costs have memory of their own.
inline Halo halo_of(const ViewSettings& settings, bool costs_apart) {
  const int step = settings.pixel_step;
  Halo halo{step, tile_columns + 2 * (settings.window_half_width / step),
            tile_rows + 2 * (settings.window_half_height / step), 0, 0};
  halo.product_columns = (halo.columns - 1) * step + 1 + 2 * settings.block_radius;
  halo.cost_columns = costs_apart ? halo.columns : halo.product_columns;
  return halo;
}

/// Tiles are counted down the columns, from the side where blocks are clipped: those take longest, and begin first.
__device__ inline Tile locate_tile(const ViewToMatch& view, const ViewSettings& settings, const Halo& halo, int index) {
  const int width = view.own.width(), down = tiles_along(view.own.height(), settings, tile_rows);
  const int across = tiles_along(width, settings, tile_columns), column = index / down;
  Tile tile;
  tile.halo = halo;
  const int first_u = (view.mirrored ? across - 1 - column : column) * tile_columns * tile.halo.step;
  const int end_u = min(first_u + tile_columns * tile.halo.step, width);
  tile.first_i = view.mirrored ? width - end_u : first_u;
  tile.columns = (end_u - first_u + tile.halo.step - 1) / tile.halo.step;
  tile.first_v = index % down * tile_rows * tile.halo.step;
  tile.halo_i = tile.first_i - settings.window_half_width;
  tile.halo_v = tile.first_v - settings.window_half_height;
  tile.range = {0, static_cast<std::int16_t>(view.disparities)};
  if (!view.ranges.empty()) tile.range = view.ranges(first_u / view.range_columns, tile.first_v / view.range_rows);
  return tile;
}

/// The last first column of the rows in the tile's halo: what is whole right of it is whole in every row.
__device__ inline int latest_first_column(const ViewToMatch& view, const Tile& tile, int* of_block) {
  const int lane = static_cast<int>(threadIdx.x);
  if (lane < 32) {
    int latest = 0;
    for (int y = lane; y < tile.halo.rows; y += 32) {
      const int v = min(max(tile.halo_v + y * tile.halo.step, 0), view.own.height() - 1);
      latest = max(latest, __ldg(view.first_column + v));
    }
    latest = warp_max(latest);
    if (lane == 0) *of_block = latest;
  }
  __syncthreads();
  return *of_block;
}

/// Whether every pixel of the tile's halo has a whole set of four costs.
__device__ inline bool halo_whole(const ViewToMatch& view, const Tile& tile, int latest_first, int d) {
  const int width = view.own.width();
  const int first_visible = view.mirrored ? 0 : latest_first;
  const int last_valid = view.mirrored ? width - 1 - latest_first : width - 1;
  return tile.halo_v >= 0 && tile.halo_v + (tile.halo.rows - 1) * tile.halo.step < view.own.height() &&
         tile.halo_i >= 0 && tile.halo_i + (tile.halo.columns - 1) * tile.halo.step <= last_valid &&
         tile.halo_i - d - (chunk - 1) >= first_visible;
}

}  // namespace roadstereo::cuda

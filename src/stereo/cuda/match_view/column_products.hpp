#pragma once

#include "core/cuda/unroll.hpp"
#include "core/mid_grey.hpp"
#include "stereo/cuda/match_view/staged_pixels.hpp"

// Products of both views summed over the rows of a block, sliding down the columns of the halo.

namespace roadstereo::cuda {

/// Products of one row at one column with four disparities, added with a sign.
class ColumnProducts {
 public:
  __device__ ColumnProducts(const ViewToMatch& view, int i, int d) : view_(view) {
    const int width = view.own.width();
    own_column_ = i >= 0 && i < width ? image_column(view, i) : -1;
    for (int k = 0; k < chunk; ++k) {
      const int j = i - d - k;
      other_column_[k] = own_column_ >= 0 && j >= 0 && j < width ? image_column(view, j) : -1;
    }
  }

  __device__ void add(int v, int sign, int4& sums) const {
    if (v < 0 || v >= view_.own.height() || own_column_ < 0) return;
    const int own = sign * (__ldg(view_.own.row(v) + own_column_) - mid_grey);
    const std::int16_t* row = view_.other.row(v);
    sums.x += own * other(row, 0);
    sums.y += own * other(row, 1);
    sums.z += own * other(row, 2);
    sums.w += own * other(row, 3);
  }

 private:
  __device__ int other(const std::int16_t* row, int k) const {
    return other_column_[k] >= 0 ? __ldg(row + other_column_[k]) - mid_grey : 0;
  }

  const ViewToMatch& view_;
  int own_column_;
  int other_column_[chunk];
};

/// A part of a column of the tile's halo that one thread slides down: rows `first` … `end` − 1 of them.
struct Strip {
  int column, first, end;
};

__device__ inline Strip strip_of_thread(const Tile& tile) {
  const int strips = max(1, threads / tile.halo.product_columns);
  const int rows = (tile.halo.rows + strips - 1) / strips;
  const int job = static_cast<int>(threadIdx.x);
  const int first = job / tile.halo.product_columns * rows;
  return {job % tile.halo.product_columns, first, min(first + rows, tile.halo.rows)};
}

/// One pixel of the own view and four neighbours of the other, and how to get to the next row.
struct StagedRow {
  const short *own, *other;
  int own_columns, other_columns;

  template <int sign>
  __device__ void add_and_advance(int4& sums) {
    const int grey = sign * *own;
    sums.x += grey * other[0];
    sums.y += grey * other[-1];
    sums.z += grey * other[-2];
    sums.w += grey * other[-3];
    own += own_columns;
    other += other_columns;
  }
};

/// products[y][c]: sums over the rows of the blocks around row y of the halo, at pixel c across it and the disparities
/// d … d + 3, of staged pixels.
__device__ inline void sum_staged_products(const Tile& tile, const StagedPixels& pixels, int row_radius, int d,
                                           int4* products) {
  const Strip strip = strip_of_thread(tile);
  if (strip.first >= strip.end) return;
  const int first_row = strip.first * tile.halo.step;
  StagedRow entering{pixels.own(first_row, strip.column), pixels.other(first_row, strip.column, d),
                     pixels.own_columns(), pixels.other_columns()};
  StagedRow leaving = entering;
  int4 sums = make_int4(0, 0, 0, 0);
  for (int k = 0; k < 2 * row_radius; ++k) entering.add_and_advance<1>(sums);
  for (int y = strip.first; y < strip.end; ++y) {
    entering.add_and_advance<1>(sums);
    products[y * tile.halo.product_columns + strip.column] = sums;
    if (y + 1 == strip.end) break;
    leaving.add_and_advance<-1>(sums);
    if (tile.halo.step > 1) {
      entering.add_and_advance<1>(sums);
      leaving.add_and_advance<-1>(sums);
    }
  }
}

/// The same of blocks that are too large to be staged, from the images: pixels outside count as mid-grey.
__device__ inline void sum_products(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile, int d,
                                    int4* products) {
  const int radius = settings.block_row_radius;
  const Strip strip = strip_of_thread(tile);
  const ColumnProducts column_products(view, tile.halo_i - settings.block_radius + strip.column, d);
  int4 sums = make_int4(0, 0, 0, 0);
  const int first_v = tile.halo_v + strip.first * tile.halo.step;
  for (int v = first_v - radius; v < first_v + radius; ++v) column_products.add(v, 1, sums);
  for (int y = strip.first; y < strip.end; ++y) {
    const int v = tile.halo_v + y * tile.halo.step;
    column_products.add(v + radius, 1, sums);
    products[y * tile.halo.product_columns + strip.column] = sums;
    column_products.add(v - radius, -1, sums);
    if (tile.halo.step == 1) continue;
    column_products.add(v + 1 + radius, 1, sums);
    column_products.add(v + 1 - radius, -1, sums);
  }
}

}  // namespace roadstereo::cuda

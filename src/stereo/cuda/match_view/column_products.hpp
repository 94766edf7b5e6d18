#pragma once

#include "core/mid_grey.hpp"
#include "stereo/cuda/match_view/tile.hpp"

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

/// Whether the blocks of the tile's halo, and what they are compared with, lie inside both images.
__device__ inline bool products_inside(const ViewToMatch& view, const Tile& tile, int radius, int d) {
  const int first_i = tile.halo_i - radius;
  return tile.halo_v >= radius && tile.halo_v + (tile.halo.rows - 1) * tile.halo.step + radius < view.own.height() &&
         first_i - d - (chunk - 1) >= 0 && first_i + tile.halo.product_columns <= view.own.width();
}

/// One pixel of the own view and four neighbours of the other, and how to get to the next row.
struct RowOfPixels {
  const std::int16_t *own, *others;
  std::ptrdiff_t own_stride, other_stride;

  template <int sign>
  __device__ void add_and_advance(int4& sums) {
    const int grey = sign * (__ldg(own) - mid_grey);
    sums.x += grey * (__ldg(others) - mid_grey);
    sums.y += grey * (__ldg(others + 1) - mid_grey);
    sums.z += grey * (__ldg(others + 2) - mid_grey);
    sums.w += grey * (__ldg(others + 3) - mid_grey);
    own += own_stride;
    others += other_stride;
  }
};

/// sum_products() where products_inside(): without checks of the borders.
__device__ inline void sum_products_inside(const ViewToMatch& view, const Tile& tile, int radius, int d,
                                           int4* products) {
  const Strip strip = strip_of_thread(tile);
  if (strip.first >= strip.end) return;
  const int i = tile.halo_i - radius + strip.column, v = tile.halo_v + strip.first * tile.halo.step - radius;
  // In memory the disparities grow with the columns of a mirrored view, and against those of the other.
  const int others = view.mirrored ? image_column(view, i - d) : i - d - (chunk - 1);
  RowOfPixels entering{view.own.row(v) + image_column(view, i), view.other.row(v) + others, view.own.stride(),
                       view.other.stride()};
  RowOfPixels leaving = entering;
  int4 sums = make_int4(0, 0, 0, 0);
  for (int k = 0; k < 2 * radius; ++k) entering.add_and_advance<1>(sums);
  for (int y = strip.first; y < strip.end; ++y) {
    entering.add_and_advance<1>(sums);
    products[y * tile.halo.product_columns + strip.column] =
        view.mirrored ? sums : make_int4(sums.w, sums.z, sums.y, sums.x);
    leaving.add_and_advance<-1>(sums);
    if (tile.halo.step > 1 && y + 1 < strip.end) {
      entering.add_and_advance<1>(sums);
      leaving.add_and_advance<-1>(sums);
    }
  }
}

/// The same with missing pixels at the images' borders, which count as mid-grey.
__device__ inline void sum_products_at_border(const ViewToMatch& view, const Tile& tile, int radius, int d,
                                              int4* products) {
  const Strip strip = strip_of_thread(tile);
  const ColumnProducts column_products(view, tile.halo_i - radius + strip.column, d);
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

/// products[y][c]: sums over the rows of the blocks around row y of the halo, at pixel c across it and the disparities
/// d … d + 3.
__device__ inline void sum_products(const ViewToMatch& view, const Tile& tile, int radius, int d, int4* products) {
  if (products_inside(view, tile, radius, d)) {
    sum_products_inside(view, tile, radius, d, products);
  } else {
    sum_products_at_border(view, tile, radius, d, products);
  }
}

}  // namespace roadstereo::cuda

#pragma once

#include "core/cuda/unroll.hpp"
#include "stereo/cuda/match_view/tile.hpp"

// Matching costs, eq. (8), of the halo at four disparities.

namespace roadstereo::cuda {

inline constexpr float missing_cost = -8.0F;  // no counterpart; costs are never below 0 by more than rounding
inline constexpr float min_known_cost = -4.0F;

/// What the costs of one row need to know of it.
struct CostRow {
  int v, radius, pixel_rows;
  float inverse_whole;  ///< 1 / n of whole blocks
  int first_visible, last_valid;
  const BlockPart *own_blocks, *other_blocks;  ///< of this row
};

/// Σ over the columns of a block that both views see, at four disparities. The columns of the other view move with
/// them.
struct ClippedSums {
  int products[chunk], own[chunk], own_squares[chunk], other[chunk], other_squares[chunk];
};

/// The costs of own pixel i at the disparities d … d + 3, each over the part of the block that both views see;
/// `row_products` are those of the column halo_i − radius on. What is read of a column serves all of them.
template <int known_radius>
__device__ float4 clipped_costs(const ViewToMatch& view, const CostRow& row, const int4* row_products,
                                float noise_variance, int halo_i, int i, int d) {
  const int radius = known_radius > 0 ? known_radius : row.radius;
  const int first = max(i - radius, 0), last = min(i + radius, row.last_valid);
  ClippedSums sums{};
  ColumnSums others[chunk];  // of the other view at q − d − k
  const auto other_at = [&](int j) { return view.other_columns(image_column(view, max(j, 0)), row.v); };
  ROADSTEREO_UNROLL
  for (int k = 1; k < chunk; ++k) others[k] = other_at(first - 1 - d - (k - 1));
  ROADSTEREO_DO_NOT_UNROLL
  for (int q = first; q <= last; ++q) {
    others[0] = other_at(q - d);
    const ColumnSums own = view.own_columns(image_column(view, q), row.v);
    const int4 of_column = row_products[q - halo_i + radius];
    const int products[chunk]{of_column.x, of_column.y, of_column.z, of_column.w};
    ROADSTEREO_UNROLL
    for (int k = 0; k < chunk; ++k) {
      const bool seen = q - d - k >= row.first_visible;
      sums.products[k] += seen ? products[k] : 0;
      sums.own[k] += seen ? own.sum : 0;
      sums.own_squares[k] += seen ? own.squares : 0;
      sums.other[k] += seen ? others[k].sum : 0;
      sums.other_squares[k] += seen ? others[k].squares : 0;
    }
    ROADSTEREO_UNROLL
    for (int k = chunk - 1; k > 0; --k) others[k] = others[k - 1];
  }
  float costs[chunk];
  ROADSTEREO_UNROLL
  for (int k = 0; k < chunk; ++k) {
    const int columns = last - max(first, d + k + row.first_visible) + 1, n = row.pixel_rows * max(columns, 1);
    const BlockPart own = block_part(sums.own[k], sums.own_squares[k], n, noise_variance);
    const BlockPart other = block_part(sums.other[k], sums.other_squares[k], n, noise_variance);
    const float cost = correlation_cost(own, other, sums.products[k], 1.0F / static_cast<float>(n));
    costs[k] = i - d - k < row.first_visible ? missing_cost : cost;
  }
  return make_float4(costs[0], costs[1], costs[2], costs[3]);
}

/// A part in one piece: the compiler would read what it needs of it in two, for twice the traffic.
__device__ inline BlockPart read_part(const BlockPart* at) {
#if defined(__CUDA_ARCH__)
  const int4 bits = __ldg(reinterpret_cast<const int4*>(at));
  return {bits.x, bits.y, __int_as_float(bits.z), __int_as_float(bits.w)};
#else
  return *at;
#endif
}

/// The costs of own pixel i at four disparities.
template <int known_radius>
__device__ float4 four_costs(const ViewToMatch& view, const CostRow& row, const int4* row_products,
                             float noise_variance, int halo_i, int i, int d) {
  float4 costs = make_float4(missing_cost, missing_cost, missing_cost, missing_cost);
  if (i < 0 || i > row.last_valid || i - d < row.first_visible) return costs;
  const int radius = known_radius > 0 ? known_radius : row.radius;
  const bool whole = i >= radius && i + radius <= row.last_valid && i - d - (chunk - 1) - radius >= row.first_visible;
  if (!whole) return clipped_costs<known_radius>(view, row, row_products, noise_variance, halo_i, i, d);
  int4 sums = make_int4(0, 0, 0, 0);
  const int4* products = row_products + (i - halo_i);
  ROADSTEREO_UNROLL
  for (int k = 0; k <= 2 * radius; ++k) {
    sums.x += products[k].x;
    sums.y += products[k].y;
    sums.z += products[k].z;
    sums.w += products[k].w;
  }
  const BlockPart own = read_part(row.own_blocks + image_column(view, i));
  const BlockPart* other = row.other_blocks + image_column(view, i - d);
  const int step = view.mirrored ? 1 : -1;
  costs.x = correlation_cost(own, read_part(other), sums.x, row.inverse_whole);
  costs.y = correlation_cost(own, read_part(other + step), sums.y, row.inverse_whole);
  costs.z = correlation_cost(own, read_part(other + 2 * step), sums.z, row.inverse_whole);
  costs.w = correlation_cost(own, read_part(other + 3 * step), sums.w, row.inverse_whole);
  return costs;
}

/// What the costs of row y of the halo need to know of it; a row outside the image sees nothing.
__device__ inline CostRow cost_row(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile, int y) {
  const int v = tile.halo_v + y * tile.halo.step, height = view.own.height();
  const int radius = settings.block_radius, row_radius = settings.block_row_radius;
  CostRow row{v, radius, 0, 0, 0, -1, nullptr, nullptr};
  if (v < 0 || v >= height) return row;
  row.pixel_rows = min(v + row_radius, height - 1) - max(v - row_radius, 0) + 1;
  row.inverse_whole = 1.0F / static_cast<float>(row.pixel_rows * (2 * radius + 1));
  row.own_blocks = view.own_blocks.row(v);
  row.other_blocks = view.other_blocks.row(v);
  row.first_visible = first_visible(view, v);
  row.last_valid = last_valid(view, v);
  return row;
}

/// The costs of the matched pixels of the halo from the products, as many at a time as there are threads. Without
/// memory of their own, `costs` are the products: cost x of a row takes the place of product x when all have read, and
/// cost x reads products from x on, so that those of the pixels that follow are still there.
template <int known_radius, bool apart>
__device__ void make_costs(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile, const CostRow* rows,
                           int d, const int4* products, int4* costs) {
  const int columns = tile.halo.columns;
  const int rows_a_round = threads / columns, rest = threads - rows_a_round * columns;
  int y = static_cast<int>(threadIdx.x) / columns, x = static_cast<int>(threadIdx.x) - y * columns;
  for (int first = 0; first < columns * tile.halo.rows; first += threads) {
    float4 four{};
    if (y < tile.halo.rows) {
      four = four_costs<known_radius>(view, rows[y], products + y * tile.halo.product_columns, settings.noise_variance,
                                      tile.halo_i, tile.halo_i + x * tile.halo.step, d);
    }
    if (!apart) __syncthreads();
    if (y < tile.halo.rows) {
      costs[y * tile.halo.cost_columns + x] =
          make_int4(__float_as_int(four.x), __float_as_int(four.y), __float_as_int(four.z), __float_as_int(four.w));
    }
    x += rest;
    y += rows_a_round + (x >= columns ? 1 : 0);
    x -= x >= columns ? columns : 0;
  }
}

}  // namespace roadstereo::cuda

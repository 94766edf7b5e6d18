#pragma once

#include "core/cuda/unroll.hpp"
#include "stereo/cuda/match_view/tile.hpp"

// Matching costs, eq. (8), of the halo at four disparities, in the memory of the column products.

namespace roadstereo::cuda {

inline constexpr float missing_cost = -8.0F;  // no counterpart; costs are never below 0 by more than rounding
inline constexpr float min_known_cost = -4.0F;

/// What the costs of one row need to know of it.
struct CostRow {
  int v, radius, pixel_rows;
  float inverse_whole;  ///< 1 / n of whole blocks
  int first_visible, last_valid;
  const BlockPart *own_blocks, *other_blocks;  ///< of this row
  const int4* products;                        ///< of the column halo_i − radius on
};

/// The cost of own pixel i at disparity d = first of the chunk + k, over the part of the block that both views see.
__device__ inline float clipped_cost(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i,
                                     int i, int d, int k) {
  if (i - d < row.first_visible) return missing_cost;
  const int first = max(max(i - row.radius, 0), d + row.first_visible), last = min(i + row.radius, row.last_valid);
  int products = 0, own_sum = 0, own_squares = 0, other_sum = 0, other_squares = 0;
  ROADSTEREO_DO_NOT_UNROLL
  for (int q = first; q <= last; ++q) {
    const int4& of_column = row.products[q - halo_i + row.radius];
    products += k == 0 ? of_column.x : k == 1 ? of_column.y : k == 2 ? of_column.z : of_column.w;
    const ColumnSums& own = view.own_columns(image_column(view, q), row.v);
    const ColumnSums& other = view.other_columns(image_column(view, q - d), row.v);
    own_sum += own.sum;
    own_squares += own.squares;
    other_sum += other.sum;
    other_squares += other.squares;
  }
  const int n = row.pixel_rows * (last - first + 1);
  return correlation_cost(block_part(own_sum, own_squares, n, noise_variance),
                          block_part(other_sum, other_squares, n, noise_variance), products,
                          1.0F / static_cast<float>(n));
}

/// The same at four disparities. Not unrolled: few tiles need it, and its registers would be taken from the weights.
__device__ inline float4 clipped_costs(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i,
                                       int i, int d) {
  float4 costs = make_float4(missing_cost, missing_cost, missing_cost, missing_cost);
  ROADSTEREO_DO_NOT_UNROLL
  for (int k = 0; k < chunk; ++k) {
    const float cost = clipped_cost(view, row, noise_variance, halo_i, i, d + k, k);
    costs.x = k == 0 ? cost : costs.x;
    costs.y = k == 1 ? cost : costs.y;
    costs.z = k == 2 ? cost : costs.z;
    costs.w = k == 3 ? cost : costs.w;
  }
  return costs;
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
__device__ inline float4 four_costs(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i,
                                    int i, int d) {
  float4 costs = make_float4(missing_cost, missing_cost, missing_cost, missing_cost);
  if (i < 0 || i > row.last_valid || i - d < row.first_visible) return costs;
  const bool whole =
      i >= row.radius && i + row.radius <= row.last_valid && i - d - (chunk - 1) - row.radius >= row.first_visible;
  if (!whole) return clipped_costs(view, row, noise_variance, halo_i, i, d);
  int4 sums = make_int4(0, 0, 0, 0);
  const int4* products = row.products + (i - halo_i);
  for (int k = 0; k <= 2 * row.radius; ++k) {
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

inline constexpr int max_half_window = 10;  // MatcherOptions::validate()
static_assert(tile_columns + 2 * max_half_window <= 2 * 32, "a lane has two costs of a row");

/// Replaces the products by the costs of the matched pixels, a warp to a row: all its lanes have read before one
/// writes.
__device__ inline void make_costs(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile, int d,
                                  int4* products) {
  const int lane = static_cast<int>(threadIdx.x) % 32, warp = static_cast<int>(threadIdx.x) / 32;
  for (int y = warp; y < tile.halo.rows; y += warps) {
    const int v = tile.halo_v + y * tile.halo.step, height = view.own.height();
    const bool inside = v >= 0 && v < height;
    int4* row = products + y * tile.halo.product_columns;
    CostRow cost_row{v, settings.block_radius, 0, 0, 0, -1, nullptr, nullptr, row};
    if (inside) {
      cost_row.pixel_rows = min(v + settings.block_radius, height - 1) - max(v - settings.block_radius, 0) + 1;
      cost_row.inverse_whole = 1.0F / static_cast<float>(cost_row.pixel_rows * (2 * settings.block_radius + 1));
      cost_row.own_blocks = view.own_blocks.row(v);
      cost_row.other_blocks = view.other_blocks.row(v);
      cost_row.first_visible = first_visible(view, v);
      cost_row.last_valid = last_valid(view, v);
    }
    const int i = tile.halo_i + lane * tile.halo.step;
    const bool second = lane + 32 < tile.halo.columns;
    const float4 near = four_costs(view, cost_row, settings.noise_variance, tile.halo_i, i, d);
    float4 far = make_float4(missing_cost, missing_cost, missing_cost, missing_cost);
    if (second) far = four_costs(view, cost_row, settings.noise_variance, tile.halo_i, i + 32 * tile.halo.step, d);
    __syncwarp();
    row[lane] =
        make_int4(__float_as_int(near.x), __float_as_int(near.y), __float_as_int(near.z), __float_as_int(near.w));
    if (second) {
      row[lane + 32] =
          make_int4(__float_as_int(far.x), __float_as_int(far.y), __float_as_int(far.z), __float_as_int(far.w));
    }
  }
}

}  // namespace roadstereo::cuda

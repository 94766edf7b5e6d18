#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "core/cuda/warp.hpp"
#include "core/mid_grey.hpp"
#include "stereo/cuda/match_view.hpp"
#include "stereo/sub_pixel.hpp"

// A block of threads matches one tile of 32×12 pixels, four disparities at a time: column sums of products slide down
// the tile and its surroundings, costs take their place in shared memory, and every thread aggregates its own pixel
// with weights that it computed once. Winner-take-all needs the smallest energy before it can lean on the prior, so the
// energies of a tile are kept in a slice of global memory that is written and read by the same thread and stays in L2.
//
// Floor per pixel and disparity, T taps, blocks of (2r+1)², surroundings s = (32 + 2R)(12 + 2R')/384 times the tile:
//   products 4s operations, block sums (2r+1)s, costs 8s, aggregation T, choice 6;
//   shared memory 4 ((2r+3)s + T) bytes; global memory 8 bytes of energies, in L2.
// Default (r 2, R 8, R' 4, T 25, s 2.5): 74 operations, 170 bytes of shared memory. 640×360, D 32: 0.54 G operations
// and 1.25 GB, for which an H200 (132 multiprocessors, 1.7 GHz, 128 lanes and 128 bytes a cycle each) needs 19 and 44
// µs: the floor is 44 µs, less by as much as the search ranges leave out. Paper (r 5, R = R' 4, T 57, s 2.1, two
// views): 170 µs.

namespace roadstereo::cuda {
namespace {

constexpr int tile_columns = 32;
constexpr int tile_rows = 12;
constexpr int threads = tile_columns * tile_rows;
constexpr int warps = threads / 32;
constexpr int chunk = 4;               // disparities at a time
constexpr float missing_cost = -8.0F;  // no counterpart; costs are never below 0 by more than rounding
constexpr float min_known_cost = -4.0F;

/// Windows of up to so many taps have their weights in registers.
constexpr int taps_of_default = 28, taps_of_paper = 60;

/// Offsets of the window's taps in shared memory, in bytes: a kernel's parameters are constants to it, which then take
/// part in the address of a read. Numbered in costs, the addresses of all taps would be computed before and kept in
/// local memory.
template <int most>
struct TapOffsets {
  int bytes[most > 0 ? most : 1];

  __device__ const int4& costs(const int4* centre, int tap) const {
    return *reinterpret_cast<const int4*>(reinterpret_cast<const unsigned char*>(centre) + bytes[tap]);
  }
};

/// So many taps are asked for together whether the window has them; those that it has not weigh nothing.
constexpr int taps_at_once = 5;

/// Where the tile and its surroundings lie, in the view's own coordinates.
struct Tile {
  int first_i, columns;  ///< the tile itself
  int first_v;
  int halo_i, halo_v;  ///< with the window's reach
  int halo_columns, halo_rows;
  int product_columns;  ///< with the blocks' reach, on both sides
  SearchRange range;
};

__device__ int image_column(const ViewToMatch& view, int i) {
  return view.mirrored ? view.own.width() - 1 - i : i;
}
/// Own pixel i of row v sees the other view from disparity 0 to i − first_visible(v).
__device__ int first_visible(const ViewToMatch& view, int v) {
  return view.mirrored ? 0 : __ldg(view.first_column + v);
}
__device__ int last_valid(const ViewToMatch& view, int v) {
  return view.mirrored ? view.own.width() - 1 - __ldg(view.first_column + v) : view.own.width() - 1;
}

__device__ Tile locate_tile(const ViewToMatch& view, const ViewSettings& settings, int index) {
  const int across = (view.own.width() + tile_columns - 1) / tile_columns;
  const int first_u = index % across * tile_columns, end_u = min(first_u + tile_columns, view.own.width());
  Tile tile;
  tile.first_i = view.mirrored ? view.own.width() - end_u : first_u;
  tile.columns = end_u - first_u;
  tile.first_v = index / across * tile_rows;
  tile.halo_i = tile.first_i - settings.window_half_width;
  tile.halo_v = tile.first_v - settings.window_half_height;
  tile.halo_columns = tile_columns + 2 * settings.window_half_width;
  tile.halo_rows = tile_rows + 2 * settings.window_half_height;
  tile.product_columns = tile.halo_columns + 2 * settings.block_radius;
  tile.range = {0, static_cast<std::int16_t>(view.disparities)};
  if (!view.ranges.empty()) tile.range = view.ranges(first_u / view.range_columns, tile.first_v / view.range_rows);
  return tile;
}

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

/// A part of a column of the tile's surroundings that one thread slides down: rows `first` … `end` − 1 of them.
struct Strip {
  int column, first, end;
};

__device__ Strip strip_of_thread(const Tile& tile) {
  const int strips = max(1, threads / tile.product_columns);
  const int rows = (tile.halo_rows + strips - 1) / strips;
  const int job = static_cast<int>(threadIdx.x);
  const int first = job / tile.product_columns * rows;
  return {job % tile.product_columns, first, min(first + rows, tile.halo_rows)};
}

/// Whether the blocks of the tile's surroundings, and what they are compared with, lie inside both images.
__device__ bool products_inside(const ViewToMatch& view, const Tile& tile, int radius, int d) {
  const int first_i = tile.halo_i - radius;
  return tile.halo_v >= radius && tile.halo_v + tile.halo_rows + radius <= view.own.height() &&
         first_i - d - (chunk - 1) >= 0 && first_i + tile.product_columns <= view.own.width();
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

/// sum_products() where products_inside(): nothing is asked of a pixel.
__device__ void sum_products_inside(const ViewToMatch& view, const Tile& tile, int radius, int d, int4* products) {
  const Strip strip = strip_of_thread(tile);
  if (strip.first >= strip.end) return;
  const int i = tile.halo_i - radius + strip.column, v = tile.halo_v + strip.first - radius;
  // In memory the disparities grow with the columns of a mirrored view, and against those of the other.
  const int others = view.mirrored ? image_column(view, i - d) : i - d - (chunk - 1);
  RowOfPixels entering{view.own.row(v) + image_column(view, i), view.other.row(v) + others, view.own.stride(),
                       view.other.stride()};
  RowOfPixels leaving = entering;
  int4 sums = make_int4(0, 0, 0, 0);
  for (int k = 0; k < 2 * radius; ++k) entering.add_and_advance<1>(sums);
  for (int y = strip.first; y < strip.end; ++y) {
    entering.add_and_advance<1>(sums);
    products[y * tile.product_columns + strip.column] =
        view.mirrored ? sums : make_int4(sums.w, sums.z, sums.y, sums.x);
    leaving.add_and_advance<-1>(sums);
  }
}

/// The same with missing pixels at the images' borders, which count as mid-grey.
__device__ void sum_products_at_border(const ViewToMatch& view, const Tile& tile, int radius, int d, int4* products) {
  const Strip strip = strip_of_thread(tile);
  const ColumnProducts column_products(view, tile.halo_i - radius + strip.column, d);
  int4 sums = make_int4(0, 0, 0, 0);
  for (int y = strip.first - radius; y < strip.first + radius; ++y) column_products.add(tile.halo_v + y, 1, sums);
  for (int y = strip.first; y < strip.end; ++y) {
    column_products.add(tile.halo_v + y + radius, 1, sums);
    products[y * tile.product_columns + strip.column] = sums;
    column_products.add(tile.halo_v + y - radius, -1, sums);
  }
}

/// products[y][c]: sums over the rows of the blocks around row y, at column c and the disparities d … d + 3.
__device__ void sum_products(const ViewToMatch& view, const Tile& tile, int radius, int d, int4* products) {
  if (products_inside(view, tile, radius, d)) {
    sum_products_inside(view, tile, radius, d, products);
  } else {
    sum_products_at_border(view, tile, radius, d, products);
  }
}

/// What the costs of one row need to know of it.
struct CostRow {
  int v, radius, pixel_rows;
  float inverse_whole;  ///< 1 / n of whole blocks
  int first_visible, last_valid;
  const BlockPart *own_blocks, *other_blocks;  ///< of this row
  const int4* products;                        ///< of the column halo_i − radius on
};

/// The cost of own pixel i at disparity d = first of the chunk + k, over the part of the block that both views see.
__device__ float clipped_cost(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i, int i,
                              int d, int k) {
  if (i - d < row.first_visible) return missing_cost;
  const int first = max(max(i - row.radius, 0), d + row.first_visible), last = min(i + row.radius, row.last_valid);
  int products = 0, own_sum = 0, own_squares = 0, other_sum = 0, other_squares = 0;
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
__device__ float4 clipped_costs(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i, int i,
                                int d) {
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
__device__ BlockPart read_part(const BlockPart* at) {
#if defined(__CUDA_ARCH__)
  const int4 bits = __ldg(reinterpret_cast<const int4*>(at));
  return {bits.x, bits.y, __int_as_float(bits.z), __int_as_float(bits.w)};
#else
  return *at;
#endif
}

/// The costs of own pixel i at four disparities.
__device__ float4 four_costs(const ViewToMatch& view, const CostRow& row, float noise_variance, int halo_i, int i,
                             int d) {
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

/// Puts the costs in the place of the products, row by row, a warp to a row: all its lanes have read before one writes.
__device__ void make_costs(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile, int d,
                           int4* products) {
  const int lane = static_cast<int>(threadIdx.x) % 32, warp = static_cast<int>(threadIdx.x) / 32;
  for (int y = warp; y < tile.halo_rows; y += warps) {
    const int v = tile.halo_v + y, height = view.own.height();
    const bool inside = v >= 0 && v < height;
    int4* row = products + y * tile.product_columns;
    CostRow cost_row{v, settings.block_radius, 0, 0, 0, -1, nullptr, nullptr, row};
    if (inside) {
      cost_row.pixel_rows = min(v + settings.block_radius, height - 1) - max(v - settings.block_radius, 0) + 1;
      cost_row.inverse_whole = 1.0F / static_cast<float>(cost_row.pixel_rows * (2 * settings.block_radius + 1));
      cost_row.own_blocks = view.own_blocks.row(v);
      cost_row.other_blocks = view.other_blocks.row(v);
      cost_row.first_visible = first_visible(view, v);
      cost_row.last_valid = last_valid(view, v);
    }
    const int i = tile.halo_i + lane;
    const bool second = lane + 32 < tile.halo_columns;
    const float4 near = four_costs(view, cost_row, settings.noise_variance, tile.halo_i, i, d);
    float4 far = make_float4(missing_cost, missing_cost, missing_cost, missing_cost);
    if (second) far = four_costs(view, cost_row, settings.noise_variance, tile.halo_i, i + 32, d);
    __syncwarp();
    row[lane] =
        make_int4(__float_as_int(near.x), __float_as_int(near.y), __float_as_int(near.z), __float_as_int(near.w));
    if (second) {
      row[lane + 32] =
          make_int4(__float_as_int(far.x), __float_as_int(far.y), __float_as_int(far.z), __float_as_int(far.w));
    }
  }
}

/// ω of a tap of the pixel (i, v): eqs. (31), (32).
__device__ float tap_weight(const ViewToMatch& view, const ViewSettings& settings, const WindowTap& tap, int i, int v,
                            int grey) {
  const int q = min(max(i + tap.du, 0), view.own.width() - 1), row = min(max(v + tap.dv, 0), view.own.height() - 1);
  const auto difference = static_cast<float>(__ldg(view.own.row(row) + image_column(view, q)) - grey);
  return exp2f(tap.log2_space + settings.log2_colour * difference * difference);
}

/// Weights of a pixel's taps: in registers where there are `most` of them, else made anew for every chunk.
template <int most>
struct PixelWeights {
  float of_tap[most > 0 ? most : 1];
  float inverse_sum;
};

/// Σ ω c and Σ ω of four disparities.
struct Aggregate {
  float4 weighted;
  float4 weights;
};

/// Adds a tap whose costs are all there.
__device__ void add_whole(const int4& costs, float weight, Aggregate& sums) {
  sums.weighted.x += weight * __int_as_float(costs.x);
  sums.weighted.y += weight * __int_as_float(costs.y);
  sums.weighted.z += weight * __int_as_float(costs.z);
  sums.weighted.w += weight * __int_as_float(costs.w);
}

__device__ void add_known(float cost, float weight, float& weighted, float& weights) {
  if (!(cost > min_known_cost)) return;
  weighted += weight * cost;
  weights += weight;
}

__device__ void add_clipped(const int4& costs, float weight, Aggregate& sums) {
  add_known(__int_as_float(costs.x), weight, sums.weighted.x, sums.weights.x);
  add_known(__int_as_float(costs.y), weight, sums.weighted.y, sums.weights.y);
  add_known(__int_as_float(costs.z), weight, sums.weighted.z, sums.weights.z);
  add_known(__int_as_float(costs.w), weight, sums.weighted.w, sums.weights.w);
}

/// Σ ω c and Σ ω where a cost may be missing: the weights are those of the others.
template <int most>
__device__ Aggregate aggregate_clipped(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile,
                                       const TapOffsets<most>& offsets, const PixelWeights<most>& weights, int i, int v,
                                       int grey, const int4* centre) {
  Aggregate sums{make_float4(0, 0, 0, 0), make_float4(0, 0, 0, 0)};
  if (most > 0) {
    ROADSTEREO_UNROLL
    for (int t = 0; t < most; ++t) {
      if (t < settings.tap_count) add_clipped(offsets.costs(centre, t), weights.of_tap[t], sums);
    }
  } else {
    for (int t = 0; t < settings.tap_count; ++t) {
      const WindowTap tap = settings.taps[t];
      add_clipped(centre[tap.dv * tile.product_columns + tap.du], tap_weight(view, settings, tap, i, v, grey), sums);
    }
  }
  return sums;
}

/// Energies E_d of one pixel at four disparities (eq. (11)) where no cost is missing.
template <int most>
__device__ float4 whole_energies(int tap_count, const TapOffsets<most>& offsets, const PixelWeights<most>& weights,
                                 const int4* centre) {
  Aggregate sums{make_float4(0, 0, 0, 0), make_float4(0, 0, 0, 0)};
  ROADSTEREO_UNROLL
  for (int first = 0; first < most; first += taps_at_once) {
    if (first >= tap_count) continue;
    ROADSTEREO_UNROLL
    for (int t = first; t < first + taps_at_once; ++t) {
      if (t < most) add_whole(offsets.costs(centre, t), weights.of_tap[t], sums);
    }
  }
  const float scale = weights.inverse_sum;
  return make_float4(sums.weighted.x * scale, sums.weighted.y * scale, sums.weighted.z * scale,
                     sums.weighted.w * scale);
}

/// The mean of what there is; infinite where the pixel itself has no counterpart.
__device__ float clipped_energy(int own_cost, float weighted, float weights) {
  return __int_as_float(own_cost) > min_known_cost ? weighted / weights : INFINITY;
}

__device__ float4 clipped_energies(const int4& own, const Aggregate& sums) {
  return make_float4(
      clipped_energy(own.x, sums.weighted.x, sums.weights.x), clipped_energy(own.y, sums.weighted.y, sums.weights.y),
      clipped_energy(own.z, sums.weighted.z, sums.weights.z), clipped_energy(own.w, sums.weighted.w, sums.weights.w));
}

/// The energies of one thread's pixel, one for every disparity of its range.
class PixelEnergies {
 public:
  __device__ PixelEnergies(float* of_block, const SearchRange& range)
      : values_(of_block + threadIdx.x), first_(range.first), end_(range.end) {}

  __device__ int first() const { return first_; }
  __device__ int end() const { return end_; }
  __device__ float operator()(int d) const { return values_[std::ptrdiff_t{d - first_} * threads]; }
  __device__ void set(int d, float energy) {
    if (d < end_) values_[std::ptrdiff_t{d - first_} * threads] = energy;
  }

 private:
  float* values_;
  int first_, end_;
};

/// Winner-take-all: the disparity of the smallest energy plus what the prior asks for; −1 where there is none.
__device__ int take_winner(const ViewToMatch& view, const ViewSettings& settings, const PixelEnergies& energies, int u,
                           int v) {
  float smallest = INFINITY;
  int winner = -1;
  for (int d = energies.first(); d < energies.end(); ++d) {
    const float energy = energies(d);
    if (energy < smallest) {
      smallest = energy;
      winner = d;
    }
  }
  if (view.prior.empty() || winner < 0) return winner;
  const float centre = view.prior(min(u / view.prior_factor, view.prior.width() - 1),
                                  min(v / view.prior_factor, view.prior.height() - 1));
  if (!(centre == centre)) return winner;
  const float weight = settings.prior_weight * prior_share(smallest);
  float best = INFINITY;
  for (int d = energies.first(); d < energies.end(); ++d) {
    const float regularised =
        energies(d) + prior_cost(weight, settings.prior_truncation_px, centre, static_cast<float>(d));
    if (regularised < best) {
      best = regularised;
      winner = d;
    }
  }
  return winner;
}

__device__ void choose(const ViewToMatch& view, const ViewSettings& settings, const PixelEnergies& energies, int u,
                       int v, const ViewWinners& winners) {
  const int winner = take_winner(view, settings, energies, u, v);
  winners.winner(u, v) = static_cast<std::int16_t>(winner);
  if (winners.offset.empty()) return;
  SubPixel sub_pixel{NAN, INFINITY};
  const bool bracketed = winner > energies.first() && winner + 1 < energies.end() && energies(winner + 1) < INFINITY;
  if (bracketed) {
    sub_pixel = fit_parabola(energies(winner - 1), energies(winner), energies(winner + 1), settings.effective_samples);
  }
  winners.offset(u, v) = sub_pixel.offset;
  winners.variance(u, v) = sub_pixel.variance;
}

/// The last first column of the rows in the tile's surroundings: what is whole right of it is whole in every row.
__device__ int latest_first_column(const ViewToMatch& view, const Tile& tile, int* of_block) {
  const int lane = static_cast<int>(threadIdx.x);
  if (lane < 32) {
    int latest = 0;
    for (int y = lane; y < tile.halo_rows; y += 32) {
      const int v = min(max(tile.halo_v + y, 0), view.own.height() - 1);
      latest = max(latest, __ldg(view.first_column + v));
    }
    latest = warp_max(latest);
    if (lane == 0) *of_block = latest;
  }
  __syncthreads();
  return *of_block;
}

/// Whether every pixel of the tile's surroundings has a whole set of four costs.
__device__ bool surroundings_whole(const ViewToMatch& view, const Tile& tile, int latest_first, int d) {
  const int width = view.own.width();
  const int first_visible = view.mirrored ? 0 : latest_first;
  const int last_valid = view.mirrored ? width - 1 - latest_first : width - 1;
  return tile.halo_v >= 0 && tile.halo_v + tile.halo_rows <= view.own.height() && tile.halo_i >= 0 &&
         tile.halo_i + tile.halo_columns - 1 <= last_valid && tile.halo_i - d - (chunk - 1) >= first_visible;
}

template <int most>
__device__ void match_tile(const ViewToMatch& view, const ViewSettings& settings, const TapOffsets<most>& offsets,
                           const Tile& tile, float* energies_of_block, const ViewWinners& winners) {
  int4* products = shared_memory<int4>();
  const int latest_first =
      latest_first_column(view, tile, reinterpret_cast<int*>(products + tile.halo_rows * tile.product_columns));
  const int x = static_cast<int>(threadIdx.x) % tile_columns, y = static_cast<int>(threadIdx.x) / tile_columns;
  const int i = tile.first_i + x, v = tile.first_v + y;
  const bool wanted = x < tile.columns && v < view.own.height();
  PixelEnergies energies(energies_of_block, tile.range);
  PixelWeights<most> weights{};
  const int grey = wanted ? __ldg(view.own.row(v) + image_column(view, i)) : 0;
  if (most > 0 && wanted) {
    float sum = 0;
    ROADSTEREO_UNROLL
    for (int t = 0; t < most; ++t) {
      weights.of_tap[t] = t < settings.tap_count ? tap_weight(view, settings, settings.taps[t], i, v, grey) : 0.0F;
      sum += weights.of_tap[t];
    }
    weights.inverse_sum = 1 / sum;
  }
  const int4* centre =
      products + (y + settings.window_half_height) * tile.product_columns + x + settings.window_half_width;
  for (int d = tile.range.first; d < tile.range.end; d += chunk) {
    sum_products(view, tile, settings.block_radius, d, products);
    __syncthreads();
    make_costs(view, settings, tile, d, products);
    __syncthreads();
    if (wanted) {
      const bool whole = surroundings_whole(view, tile, latest_first, d);
      const float4 four = most > 0 && whole
                              ? whole_energies<most>(settings.tap_count, offsets, weights, centre)
                              : clipped_energies(*centre, aggregate_clipped<most>(view, settings, tile, offsets,
                                                                                  weights, i, v, grey, centre));
      energies.set(d, four.x);
      energies.set(d + 1, four.y);
      energies.set(d + 2, four.z);
      energies.set(d + 3, four.w);
    }
    __syncthreads();
  }
  if (wanted) choose(view, settings, energies, image_column(view, i), v, winners);
}

template <int most>
__global__ void __launch_bounds__(threads, most <= taps_of_default ? 2 : 1)
    match_tiles(ViewToMatch view, ViewSettings settings, TapOffsets<most> offsets, float* energies,
                std::size_t energies_per_block, ViewWinners winners) {
  const int across = (view.own.width() + tile_columns - 1) / tile_columns;
  const int tiles = across * ((view.own.height() + tile_rows - 1) / tile_rows);
  for (int index = static_cast<int>(blockIdx.x); index < tiles; index += static_cast<int>(gridDim.x)) {
    const Tile tile = locate_tile(view, settings, index);
    match_tile<most>(view, settings, offsets, tile, energies + blockIdx.x * energies_per_block, winners);
    __syncthreads();
  }
}

template <int most>
void launch_tiles(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                  const ViewLaunch& plan, float* energies, const ViewWinners& winners, cudaStream_t stream) {
  const int columns = tile_columns + 2 * (settings.window_half_width + settings.block_radius);
  TapOffsets<most> offsets{};
  for (int t = 0; most > 0 && t < settings.tap_count; ++t) {
    offsets.bytes[t] = (taps_on_host[t].dv * columns + taps_on_host[t].du) * static_cast<int>(sizeof(int4));
  }
  launch(match_tiles<most>, {static_cast<unsigned>(plan.blocks), threads, plan.shared_bytes}, stream, view, settings,
         offsets, energies, plan.energies_per_block, winners);
}

}  // namespace

ViewLaunch plan_view_launch(const ViewSettings& settings, int width, int height, int disparities, int multiprocessors) {
  constexpr int blocks_per_multiprocessor = 2;
  constexpr std::size_t max_energies = std::size_t{64} << 20;  // 256 MB
  constexpr int reserve = 64;                                  // disparities are counted in multiples of this
  ViewLaunch plan;
  // The number of disparities follows the road: a few more in the next frame need no new memory.
  const int with_reserve = reserve * static_cast<int>(blocks_for(disparities, reserve));
  plan.energies_per_block = static_cast<std::size_t>(threads) * static_cast<std::size_t>(with_reserve);
  const int tiles = ((width + tile_columns - 1) / tile_columns) * ((height + tile_rows - 1) / tile_rows);
  const auto room = static_cast<int>(max_energies / plan.energies_per_block);
  const int resident = blocks_per_multiprocessor * multiprocessors;
  plan.blocks = tiles < resident ? tiles : resident;
  plan.blocks = plan.blocks < room ? plan.blocks : room;
  const int rows = tile_rows + 2 * settings.window_half_height;
  const int columns = tile_columns + 2 * (settings.window_half_width + settings.block_radius);
  plan.shared_bytes = sizeof(int4) * static_cast<std::size_t>(rows * columns + 1);
  return plan;
}

void match_view(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                const ViewLaunch& plan, float* energies, const ViewWinners& winners, cudaStream_t stream) {
  if (settings.tap_count == 1) {
    launch_tiles<1>(view, settings, taps_on_host, plan, energies, winners, stream);
  } else if (settings.tap_count <= taps_of_default) {
    launch_tiles<taps_of_default>(view, settings, taps_on_host, plan, energies, winners, stream);
  } else if (settings.tap_count <= taps_of_paper) {
    launch_tiles<taps_of_paper>(view, settings, taps_on_host, plan, energies, winners, stream);
  } else {
    launch_tiles<0>(view, settings, taps_on_host, plan, energies, winners, stream);
  }
}

}  // namespace roadstereo::cuda

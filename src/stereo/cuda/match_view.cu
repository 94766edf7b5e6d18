#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "stereo/cuda/match_view/aggregation.hpp"
#include "stereo/cuda/match_view/block_costs.hpp"
#include "stereo/cuda/match_view/column_products.hpp"
#include "stereo/cuda/match_view/staged_pixels.hpp"
#include "stereo/cuda/match_view/tile.hpp"
#include "stereo/cuda/match_view/winner_take_all.hpp"

// A block of threads matches one tile of 32×8 matched pixels, four disparities at a time: the grey levels around it are
// staged in shared memory, column sums of their products slide down the tile and its halo, costs replace them, and
// every thread aggregates its own pixel with weights that it computed once. The weight of the prior depends on the
// smallest energy, so that the energies of a tile are kept in a slice of global memory that is written and read by the
// same thread and stays in L2.
//
// Floor per matched pixel and disparity, T taps, blocks of (2r+1)², every p-th pixel matched, halo s = (32 + 2R/p)(8 +
// 2R'/p)/256 times the tile:
//   products 4p²s operations, block sums (2r+1)s, costs 8s, aggregation T, choice 6;
//   shared memory (4 (2r+2+p) + 5p²)s + 4T bytes; global memory 8 bytes of energies, in L2.
// Default (r 2, R 8, R' 4, T 25, p 2, s 1.9): 86 operations, 198 bytes of shared memory. 640×360, D 32: 0.16 G
// operations and 0.36 GB, for which an H200 (132 multiprocessors, 2.0 GHz, 128 lanes and 128 bytes a cycle each) needs
// 5 and 11 µs, less by as much as the search ranges leave out. What it takes is five times that: the tiles are few more
// than multiprocessors, and a warp waits for its own results.

namespace roadstereo::cuda {
namespace {

/// `known_radius`: of the blocks, whose pixels are staged then, or 0.
template <int max_taps, int known_radius>
__device__ void match_tile(const ViewToMatch& view, const ViewSettings& settings, const TapOffsets<max_taps>& offsets,
                           const Tile& tile, bool staged, float* energies_of_block, const ViewWinners& winners) {
  int4* products = shared_memory<int4>();
  auto* rows = reinterpret_cast<CostRow*>(products + tile.halo.rows * tile.halo.product_columns);
  for (int row = static_cast<int>(threadIdx.x); row < tile.halo.rows; row += threads) {
    rows[row] = cost_row(view, settings, tile, row);
  }
  auto* latest = reinterpret_cast<int*>(rows + tile.halo.rows);
  StagedPixels pixels(tile.halo, settings.block_radius, latest + 1);
  if (staged) pixels.load_own(view, tile, settings.block_radius);
  const int latest_first = latest_first_column(view, tile, latest);
  const int x = static_cast<int>(threadIdx.x) % tile_columns, y = static_cast<int>(threadIdx.x) / tile_columns;
  const int i = tile.first_i + x * tile.halo.step, v = tile.first_v + y * tile.halo.step;
  const bool wanted = x < tile.columns && v < view.own.height();
  PixelEnergies energies(energies_of_block, tile.range);
  PixelWeights<max_taps> weights{};
  const int grey = wanted ? __ldg(view.own.row(v) + image_column(view, i)) : 0;
  if (max_taps > 0 && wanted) {
    float sum = 0;
    ROADSTEREO_UNROLL
    for (int t = 0; t < max_taps; ++t) {
      weights.of_tap[t] = t < settings.tap_count ? tap_weight(view, settings, settings.taps[t], i, v, grey) : 0.0F;
      sum += weights.of_tap[t];
    }
    weights.inverse_sum = 1 / sum;
  }
  const int4* centre = products + (y + settings.window_half_height / tile.halo.step) * tile.halo.product_columns + x +
                       settings.window_half_width / tile.halo.step;
  for (int d = tile.range.first; d < tile.range.end; d += chunk) {
    if (staged) {
      if ((d - tile.range.first) % StagedPixels::disparities == 0) {
        pixels.load_other(view, tile, settings.block_radius, d);
        __syncthreads();
      }
      sum_staged_products<known_radius>(tile, pixels, settings.block_radius, d, products);
    } else {
      sum_products(view, tile, settings.block_radius, d, products);
    }
    __syncthreads();
    make_costs<known_radius>(view, settings, tile, rows, d, products);
    __syncthreads();
    if (wanted) {
      const bool whole = halo_whole(view, tile, latest_first, d);
      const float4 four = max_taps > 0 && whole
                              ? whole_energies<max_taps>(settings.tap_count, offsets, weights, centre)
                              : clipped_energies(*centre, aggregate_clipped<max_taps>(view, settings, tile, offsets,
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

/// Blocks that a multiprocessor has registers for: the weights take most of them. The kernel for more taps than any of
/// those is launched with as many blocks as that for the most, though it keeps no weights.
constexpr int resident_blocks(int taps) {
  return taps <= taps_of_default ? 3 : 2;
}

template <int max_taps, int known_radius>
__global__ void __launch_bounds__(threads, resident_blocks(max_taps))
    match_tiles(ViewToMatch view, ViewSettings settings, Halo halo, TapOffsets<max_taps> offsets, bool staged,
                float* energies, std::size_t energies_per_block, ViewWinners winners) {
  begin_kernel();
  const int tiles =
      tiles_along(view.own.width(), settings, tile_columns) * tiles_along(view.own.height(), settings, tile_rows);
  for (int index = static_cast<int>(blockIdx.x); index < tiles; index += static_cast<int>(gridDim.x)) {
    const Tile tile = locate_tile(view, settings, halo, index);
    match_tile<max_taps, known_radius>(view, settings, offsets, tile, known_radius > 0 || staged,
                                       energies + blockIdx.x * energies_per_block, winners);
    __syncthreads();
  }
}

template <int max_taps>
void launch_tiles(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                  const ViewLaunch& plan, float* energies, const ViewWinners& winners, StreamView stream) {
  const Halo halo = halo_of(settings);
  TapOffsets<max_taps> offsets{};
  for (int t = 0; max_taps > 0 && t < settings.tap_count; ++t) {
    const int rows_away = taps_on_host[t].dv / halo.step, columns_away = taps_on_host[t].du / halo.step;
    const int costs_away = rows_away * halo.product_columns + columns_away;
    offsets.bytes[t] = costs_away * static_cast<int>(sizeof(int4));
  }
  const auto run = [&](auto kernel) {
    launch("match_tiles", kernel, {static_cast<unsigned>(plan.blocks), threads, plan.shared_bytes}, stream, view,
           settings, halo, offsets, plan.staged, energies, plan.energies_per_block, winners);
  };
  // Of the presets. The kernel for any number of taps is for any blocks, too.
  constexpr int usual_radius = max_taps == 0 ? 0 : max_taps == taps_of_default ? 2 : 5;
  if (plan.staged && settings.block_radius == usual_radius) {
    run(match_tiles<max_taps, usual_radius>);
  } else {
    run(match_tiles<max_taps, 0>);
  }
}

}  // namespace

ViewLaunch plan_view_launch(const ViewSettings& settings, int width, int height, int disparities, int multiprocessors) {
  constexpr std::size_t max_energies = std::size_t{64} << 20;  // 256 MB
  constexpr int reserve = 64;                                  // disparities are counted in multiples of this
  ViewLaunch plan;
  // The number of disparities follows the road: a few more in the next frame need no new memory.
  const int with_reserve = reserve * static_cast<int>(blocks_for(disparities, reserve));
  plan.energies_per_block = static_cast<std::size_t>(threads) * static_cast<std::size_t>(with_reserve);
  const int tiles = tiles_along(width, settings, tile_columns) * tiles_along(height, settings, tile_rows);
  const auto room = static_cast<int>(max_energies / plan.energies_per_block);
  const int resident = resident_blocks(settings.tap_count) * multiprocessors;
  plan.blocks = tiles < resident ? tiles : resident;
  plan.blocks = plan.blocks < room ? plan.blocks : room;
  const Halo halo = halo_of(settings);
  plan.shared_bytes = sizeof(int4) * static_cast<std::size_t>(halo.rows * halo.product_columns + 1) +
                      sizeof(CostRow) * static_cast<std::size_t>(halo.rows);
  const std::size_t staged_bytes = plan.shared_bytes + StagedPixels::bytes(halo, settings.block_radius);
  plan.staged = staged_bytes <= max_shared_bytes;
  if (plan.staged) plan.shared_bytes = staged_bytes;
  return plan;
}

void match_view(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                const ViewLaunch& plan, float* energies, const ViewWinners& winners, StreamView stream) {
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

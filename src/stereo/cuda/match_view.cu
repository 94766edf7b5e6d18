#include <cmath>
#include <type_traits>

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "stereo/cuda/match_view/aggregation.hpp"
#include "stereo/cuda/match_view/block_costs.hpp"
#include "stereo/cuda/match_view/column_products.hpp"
#include "stereo/cuda/match_view/staged_pixels.hpp"
#include "stereo/cuda/match_view/tile.hpp"
#include "stereo/cuda/match_view/winner_take_all.hpp"

// A block of threads matches one tile of 32×8 matched pixels, four disparities at a time: the grey levels around it are
// staged in shared memory, column sums of their products slide down the tile and its halo, costs are made of them, and
// every thread aggregates its own pixel with weights that it computed once. The weight of the prior depends on the
// smallest energy, so that the energies of a tile are kept in a slice of global memory that is written and read by the
// same thread and stays in L2.
//
// Floor per matched pixel and disparity, T taps, blocks 2r+1 wide, every p-th pixel matched, halo s = (32 + 2R/p)(8 +
// 2R'/p)/256 times the tile:
//   products 4p²s operations, block sums (2r+1)s, costs 8s, aggregation T, choice 6;
//   shared memory (4 (2r+2+p) + 5p²)s + 4T bytes; global memory 8 bytes of energies, in L2.
// Default (r 4, R 8, R' 4, T 25, p 2, s 1.9): 93 operations, 228 bytes of shared memory. 640×360, D 32: 0.17 G
// operations and 0.42 GB, for which an H200 (132 multiprocessors, 2.0 GHz, 128 lanes and 128 bytes a cycle each) needs
// 5 and 12 µs, less by as much as the search ranges leave out. What it takes is five times that: the tiles are few more
// than multiprocessors, and a warp waits for its own results.

namespace roadstereo::cuda {
namespace {

/// `known_radius`: of the blocks, whose pixels are staged and whose costs lie apart then, or 0.
template <int max_taps, int known_radius>
__device__ void match_tile(const ViewToMatch& view, const ViewSettings& settings, const TapTable<max_taps>& taps,
                           const Tile& tile, bool staged, float* energies_of_block, const ViewWinners& winners) {
  constexpr bool apart = known_radius > 0;
  int4* products = shared_memory<int4>() + 1;  // after the number of the next tile
  int4* costs = apart ? products + tile.halo.rows * tile.halo.product_columns : products;
  auto* rows = reinterpret_cast<CostRow*>(costs + tile.halo.rows * tile.halo.cost_columns);
  for (int row = static_cast<int>(threadIdx.x); row < tile.halo.rows; row += threads) {
    rows[row] = cost_row(view, settings, tile, row);
  }
  auto* latest = reinterpret_cast<int*>(rows + tile.halo.rows);
  StagedPixels pixels(tile.halo, settings.block_row_radius, latest + 1);
  if (staged) pixels.load_own(view, settings, tile);
  const int latest_first = latest_first_column(view, tile, latest);
  const int x = static_cast<int>(threadIdx.x) % tile_columns, y = static_cast<int>(threadIdx.x) / tile_columns;
  const int i = tile.first_i + x * tile.halo.step, v = tile.first_v + y * tile.halo.step;
  const bool wanted = x < tile.columns && v < view.own.height();
  PixelEnergies energies(energies_of_block, tile.range);
  PixelWeights<max_taps> weights{};
  const int grey = wanted ? __ldg(view.own.row(v) + image_column(view, i)) : 0;
  if (max_taps > 0 && wanted) {
    if (staged) {
      const int row = y * tile.halo.step + settings.window_half_height + settings.block_row_radius;
      const int column = x * tile.halo.step + settings.window_half_width + settings.block_radius;
      const short* pixel = pixels.own(row, column);  // outside of the image of any grey level: there is no cost
      const int staged_grey = *pixel;
      weigh_taps<max_taps>(
          [&](int t) {
            return tap_weight(taps.log2_space[t], settings.log2_colour, taps.pixel(pixel, t) - staged_grey);
          },
          weights);
    } else {
      weigh_taps<max_taps>(
          [&](int t) {
            return t < settings.tap_count ? tap_weight(view, settings, settings.taps[t], i, v, grey) : 0.0F;
          },
          weights);
    }
  }
  const int4* centre = costs + (y + settings.window_half_height / tile.halo.step) * tile.halo.cost_columns + x +
                       settings.window_half_width / tile.halo.step;
  for (int d = tile.range.first; d < tile.range.end; d += chunk) {
    if (staged) {
      if ((d - tile.range.first) % StagedPixels::disparities == 0) {
        pixels.load_other(view, settings, tile, d);
        __syncthreads();
      }
      sum_staged_products(tile, pixels, settings.block_row_radius, d, products);
    } else {
      sum_products(view, settings, tile, d, products);
    }
    __syncthreads();
    make_costs<known_radius, apart>(view, settings, tile, rows, d, products, costs);
    __syncthreads();
    if (wanted) {
      const bool whole = halo_whole(view, tile, latest_first, d);
      const float4 four = max_taps > 0 && whole
                              ? whole_energies<max_taps>(settings.tap_count, taps, weights, centre)
                              : clipped_energies(*centre, aggregate_clipped<max_taps>(view, settings, tile, taps,
                                                                                      weights, i, v, grey, centre));
      energies.set(d, four.x);
      energies.set(d + 1, four.y);
      energies.set(d + 2, four.z);
      energies.set(d + 3, four.w);
    }
    if (!apart) __syncthreads();
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
    match_tiles(ViewToMatch view, ViewSettings settings, Halo halo, TapTable<max_taps> taps, bool staged,
                float* energies, std::size_t energies_per_block, TileTickets tickets, ViewWinners winners) {
  begin_kernel();
  const int tiles = tiles_of(view.own.width(), view.own.height(), settings), blocks = static_cast<int>(gridDim.x);
  int* next = shared_memory<int>();  // a word before the rest
  int index = static_cast<int>(blockIdx.x);
  while (index < tiles) {
    // Ranges make tiles unequal: who has matched one takes the next. Every tile draws a ticket, also the last ones.
    if (threadIdx.x == 0) {
      *next = blocks < tiles ? blocks + static_cast<int>(atomicAdd(tickets.drawn, 1U) - tickets.already) : tiles;
    }
    const Tile tile = locate_tile(view, settings, halo, index);
    match_tile<max_taps, known_radius>(view, settings, taps, tile, known_radius > 0 || staged,
                                       energies + blockIdx.x * energies_per_block, winners);
    __syncthreads();
    index = *next;
    __syncthreads();  // before the next ticket is written
  }
}

/// Of the presets `fast`, `default` and `paper`. The kernel for any number of taps is for any blocks, too.
constexpr int usual_radius(int tap_count) {
  if (tap_count > taps_of_paper) return 0;
  if (tap_count > taps_of_default) return 5;
  return tap_count > 1 ? 4 : 8;
}

template <int max_taps>
void launch_tiles(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                  const ViewLaunch& plan, float* energies, const TileTickets& tickets, const ViewWinners& winners,
                  StreamView stream) {
  const Halo halo = halo_of(settings, plan.costs_apart);
  TapTable<max_taps> taps{};
  for (int t = 0; t < max_taps; ++t) {
    taps.log2_space[t] = -INFINITY;
    if (t >= settings.tap_count) continue;
    const WindowTap& tap = taps_on_host[t];
    const int costs_away = tap.dv / halo.step * halo.cost_columns + tap.du / halo.step;
    const int pixels_away = tap.dv * halo.product_columns + tap.du;
    taps.cost_bytes[t] = costs_away * static_cast<int>(sizeof(int4));
    taps.pixel_bytes[t] = pixels_away * static_cast<int>(sizeof(short));
    taps.log2_space[t] = tap.log2_space;
  }
  const auto run = [&](auto kernel) {
    launch("match_tiles", kernel, {static_cast<unsigned>(plan.blocks), threads, plan.shared_bytes}, stream, view,
           settings, halo, taps, plan.staged, energies, plan.energies_per_block, tickets, winners);
  };
  if (plan.costs_apart) {
    run(match_tiles<max_taps, usual_radius(max_taps > 0 ? max_taps : taps_of_paper + 1)>);
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
  const int tiles = tiles_of(width, height, settings);
  const auto room = static_cast<int>(max_energies / plan.energies_per_block);
  const int resident = resident_blocks(settings.tap_count) * multiprocessors;
  plan.blocks = tiles < resident ? tiles : resident;
  plan.blocks = plan.blocks < room ? plan.blocks : room;
  const Halo halo = halo_of(settings, false);
  plan.shared_bytes = sizeof(int4) * static_cast<std::size_t>(1 + halo.rows * halo.product_columns + 1) +
                      sizeof(CostRow) * static_cast<std::size_t>(halo.rows);
  const std::size_t staged_bytes = plan.shared_bytes + StagedPixels::bytes(halo, settings.block_row_radius);
  const std::size_t apart_bytes = staged_bytes + sizeof(int4) * static_cast<std::size_t>(halo.rows * halo.columns);
  plan.staged = staged_bytes <= max_shared_bytes;
  const int usual = usual_radius(settings.tap_count);
  plan.costs_apart = usual > 0 && settings.block_radius == usual && apart_bytes <= max_shared_bytes;
  if (plan.staged) plan.shared_bytes = plan.costs_apart ? apart_bytes : staged_bytes;
  return plan;
}

unsigned match_view(const ViewToMatch& view, const ViewSettings& settings, const WindowTap* taps_on_host,
                    const ViewLaunch& plan, float* energies, const TileTickets& tickets, const ViewWinners& winners,
                    StreamView stream) {
  const auto launch_for = [&](auto most_taps) {
    launch_tiles<decltype(most_taps)::value>(view, settings, taps_on_host, plan, energies, tickets, winners, stream);
  };
  if (settings.tap_count == 1) {
    launch_for(std::integral_constant<int, 1>{});
  } else if (settings.tap_count <= taps_of_default) {
    launch_for(std::integral_constant<int, taps_of_default>{});
  } else if (settings.tap_count <= taps_of_paper) {
    launch_for(std::integral_constant<int, taps_of_paper>{});
  } else {
    launch_for(std::integral_constant<int, 0>{});
  }
  const int tiles = tiles_of(view.own.width(), view.own.height(), settings);
  return plan.blocks < tiles ? static_cast<unsigned>(tiles) : 0;
}

}  // namespace roadstereo::cuda

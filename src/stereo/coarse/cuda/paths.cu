// Floor: 8 bytes and 7 operations a cost each direction, and 8 bytes for the winners: 320×180 pixels of 24 disparities,
// 33 MB in the second cache. What counts is the chain: a column needs the smallest total of the column before it, so
// that a row takes columns × (exchange with the neighbours, smallest of a warp, three operations), about 70 cycles each
// with the hardware's minimum (compute capability 8), 170 without. Both directions of all rows run side by side.

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "core/cuda/warp.hpp"
#include "stereo/coarse/cuda/paths.hpp"
#include "stereo/coarse/path_winner.hpp"

namespace roadstereo::cuda {
namespace {

/// The disparities of a column that one lane holds: lane·count ….
template <int count>
struct alignas(count % 4 == 0   ? 16
               : count % 2 == 0 ? 8
                                : 4) LaneCosts {
  float at[count];
};

/// One path along a row, from the left or from the right.
template <int count>
struct Path {
  using Lane = LaneCosts<count>;
  const float* costs;  ///< this lane's of the first column of the path
  float* out;
  std::ptrdiff_t next;  ///< from one column of the path to the next

  __device__ Lane cost(int k) const { return *reinterpret_cast<const Lane*>(costs + k * next); }
  __device__ void store(int k, const Lane& numbers) const { *reinterpret_cast<Lane*>(out + k * next) = numbers; }
};

template <int count>
__device__ float cheapest_of(const LaneCosts<count>& totals) {
  float smallest = totals.at[0];
  ROADSTEREO_UNROLL
  for (int i = 1; i < count; ++i) smallest = fminf(smallest, totals.at[i]);
  return warp_min(smallest);
}

/// Cheapest transition from the totals of a column to each disparity of the next: stay, step by one, or jump.
template <int count>
__device__ LaneCosts<count> transition_cost(const LaneCosts<count>& totals, float cheapest,
                                            const ScanlinePenalties& penalties) {
  const auto lane = static_cast<int>(threadIdx.x);
  const float from_left = __shfl_up_sync(whole_warp, totals.at[count - 1], 1U);
  const float from_right = __shfl_down_sync(whole_warp, totals.at[0], 1U);
  const float left_end = lane == 0 ? INFINITY : from_left, right_end = lane == warp_lanes - 1 ? INFINITY : from_right;
  LaneCosts<count> path_cost;
  ROADSTEREO_UNROLL
  for (int i = 0; i < count; ++i) {
    const float left = i > 0 ? totals.at[i > 0 ? i - 1 : 0] : left_end;
    const float right = i + 1 < count ? totals.at[i + 1 < count ? i + 1 : i] : right_end;
    const float stay = totals.at[i] - cheapest, change = fminf(left, right) - cheapest;
    path_cost.at[i] = fminf(fminf(stay, change + penalties.step), penalties.jump);
  }
  return path_cost;
}

/// Aggregates along the path. Forward it writes totals, backward path costs without the column's own cost.
template <int count, bool forward>
__device__ void aggregate_path(const Path<count>& path, int columns, const ScanlinePenalties& penalties) {
  constexpr int ahead = count <= 2 ? 8 : 4;  // columns loaded ahead, to hide the latency of memory
  LaneCosts<count> totals = path.cost(0), path_cost{}, entering[ahead];
  path.store(0, forward ? totals : path_cost);
  ROADSTEREO_UNROLL
  for (int k = 0; k < ahead; ++k) entering[k] = path.cost(1 + k < columns ? 1 + k : columns - 1);
  for (int first = 1; first < columns; first += ahead) {
    ROADSTEREO_UNROLL
    for (int k = 0; k < ahead; ++k) {
      if (first + k >= columns) break;
      path_cost = transition_cost(totals, cheapest_of(totals), penalties);
      ROADSTEREO_UNROLL
      for (int i = 0; i < count; ++i) totals.at[i] = entering[k].at[i] + path_cost.at[i];
      const int wanted = first + k + ahead;
      entering[k] = path.cost(wanted < columns ? wanted : columns - 1);
      path.store(first + k, forward ? totals : path_cost);
    }
  }
}

/// A warp aggregates one row in one direction.
template <int count>
__global__ void aggregate_rows(CoarseVolume costs, ScanlinePenalties penalties, CoarseVolume forward,
                               CoarseVolume backward) {
  const int v = costs.first_row + static_cast<int>(blockIdx.x);
  const int d = static_cast<int>(threadIdx.x) * count, last = costs.columns - 1;
  if (blockIdx.y == 0) {
    aggregate_path<count, true>({costs.pixel(0, v) + d, forward.pixel(0, v) + d, costs.pitch}, costs.columns,
                                penalties);
  } else {
    aggregate_path<count, false>({costs.pixel(last, v) + d, backward.pixel(last, v) + d, -std::ptrdiff_t{costs.pitch}},
                                 costs.columns, penalties);
  }
}

constexpr int winner_warps = 8;

/// The smallest of the sums of both directions, with its fraction: a warp for each pixel.
__device__ float take_winner(const float* forward, const float* backward, int count, const float* costs,
                             const RoadCost& road) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  float smallest = INFINITY;
  int winner = 0;
  for (int d = lane; d < count; d += warp_lanes) {
    const float total = forward[d] + backward[d];
    if (total < smallest) {
      smallest = total;
      winner = d;
    }
  }
  const float lowest = warp_min(smallest);
  // Of equal totals the first disparity wins.
  winner = -warp_max(smallest == lowest ? -winner : -count);
  const auto disparity = static_cast<float>(winner);
  if (winner == 0 || winner + 1 >= count) return disparity;
  const auto total = [&](int d) { return forward[d] + backward[d]; };
  const PathWinner inside{disparity,         total(winner - 1), lowest,           total(winner + 1),
                          costs[winner - 1], costs[winner],     costs[winner + 1]};
  return disparity + fraction_of(inside, road);
}

__global__ void take_winners(CoarseVolume costs, CoarseVolume forward, CoarseVolume backward,
                             ImageView<const RoadCost> roads, const int* first_seen, ImageView<float> disparity) {
  const int v = forward.first_row + static_cast<int>(blockIdx.y);
  const int u = static_cast<int>(blockIdx.x) * winner_warps + static_cast<int>(threadIdx.x) / warp_lanes;
  if (u >= forward.columns) return;
  const int seen = u - first_seen[v] + 1, count = seen < forward.disparities ? seen : forward.disparities;
  const float winner =
      count > 0 ? take_winner(forward.pixel(u, v), backward.pixel(u, v), count, costs.pixel(u, v), roads(u, v))
                : nanf("");
  if (threadIdx.x % warp_lanes == 0) disparity(u, v) = winner;
}

using RowKernel = void (*)(CoarseVolume, ScanlinePenalties, CoarseVolume, CoarseVolume);

struct RowKernelOf {
  int count;
  RowKernel kernel;
};

constexpr RowKernelOf row_kernels[] = {{1, aggregate_rows<1>},
                                       {2, aggregate_rows<2>},
                                       {4, aggregate_rows<4>},
                                       {8, aggregate_rows<8>},
                                       {16, aggregate_rows<16>}};

const RowKernelOf& row_kernel(int disparities) {
  for (const RowKernelOf& of : row_kernels) {
    if (of.count * warp_lanes >= disparities) return of;
  }
  return row_kernels[4];
}

}  // namespace

int path_pitch(int disparities) {
  return row_kernel(disparities).count * warp_lanes;
}

void aggregate_scanlines(const CoarseVolume& costs, const ScanlinePenalties& penalties, ImageView<const RoadCost> roads,
                         const int* first_seen, const CoarseVolume& forward, const CoarseVolume& backward,
                         ImageView<float> disparity, StreamView stream) {
  const auto rows = static_cast<unsigned>(costs.rows);
  launch("aggregate_rows", row_kernel(costs.disparities).kernel, {dim3(rows, 2), warp_lanes}, stream, costs, penalties,
         forward, backward);
  launch("take_winners", take_winners, {dim3(blocks_for(costs.columns, winner_warps), rows), winner_warps * warp_lanes},
         stream, costs, forward, backward, roads, first_seen, disparity);
}

}  // namespace roadstereo::cuda

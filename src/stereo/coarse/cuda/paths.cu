// Floor: 8 bytes and 7 operations a cost each direction, and 8 bytes for the winners: 320×180 pixels of 24 disparities,
// 33 MB in the second cache. What counts is the chain: a column needs the smallest total of the column before it, so
// that a row takes columns × (exchange with the neighbours, smallest of a warp, three operations), about 100 cycles
// each on an H200 with the hardware's minimum (compute capability 8), more without. Both directions of all rows run
// side by side.

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

/// One path along a row, from the left or from the right: this lane's costs of the first column of the path.
template <int count>
struct Path {
  using Lane = LaneCosts<count>;
  const float* costs;
  float* out;
  std::ptrdiff_t next;  ///< from one column of the path to the next

  __device__ Lane cost() const { return *reinterpret_cast<const Lane*>(costs); }
  __device__ void store(const Lane& numbers) const { *reinterpret_cast<Lane*>(out) = numbers; }
};

template <int count>
__device__ float cheapest_of(const LaneCosts<count>& totals) {
  float smallest = totals.at[0];
  ROADSTEREO_UNROLL
  for (int i = 1; i < count; ++i) smallest = fminf(smallest, totals.at[i]);
  return warp_min_of_costs(smallest);
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

/// The totals of the next column of a path from those of the last one. Forward it writes them, backward path costs
/// without the column's own cost.
template <int count, bool forward>
__device__ void go_on(Path<count>& path, const LaneCosts<count>& cost, const ScanlinePenalties& penalties,
                      LaneCosts<count>& totals) {
  const LaneCosts<count> path_cost = transition_cost(totals, cheapest_of(totals), penalties);
  ROADSTEREO_UNROLL
  for (int i = 0; i < count; ++i) totals.at[i] = cost.at[i] + path_cost.at[i];
  path.out += path.next;
  path.store(forward ? totals : path_cost);
}

/// Aggregates along the path.
template <int count, bool forward>
__device__ void aggregate_path(Path<count> path, int columns, const ScanlinePenalties& penalties) {
  constexpr int ahead = count <= 2 ? 8 : 4;  // columns loaded ahead, to hide the latency of memory
  const auto next_cost = [&path] {
    path.costs += path.next;
    return path.cost();
  };
  LaneCosts<count> totals = path.cost(), entering[ahead], following[ahead];
  path.store(forward ? totals : LaneCosts<count>{});
  int left = columns - 1;  // that totals are to be found of
  ROADSTEREO_UNROLL
  for (int k = 0; k < ahead; ++k) {
    if (k < left) entering[k] = next_cost();
  }
  for (; left >= 2 * ahead; left -= ahead) {
    // Before the stores, behind which the compiler leaves a load.
    ROADSTEREO_UNROLL
    for (int k = 0; k < ahead; ++k) following[k] = next_cost();
    ROADSTEREO_UNROLL
    for (int k = 0; k < ahead; ++k) go_on<count, forward>(path, entering[k], penalties, totals);
    ROADSTEREO_UNROLL
    for (int k = 0; k < ahead; ++k) entering[k] = following[k];
  }
  ROADSTEREO_UNROLL
  for (int k = 0; k < ahead; ++k) {
    if (k < left) go_on<count, forward>(path, entering[k], penalties, totals);
  }
  for (int k = ahead; k < left; ++k) go_on<count, forward>(path, next_cost(), penalties, totals);
}

/// A warp aggregates one row in one direction.
template <int count>
__global__ void aggregate_rows(CoarseVolume costs, ScanlinePenalties penalties, CoarseVolume forward,
                               CoarseVolume backward) {
  begin_kernel();
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

constexpr int winner_threads = 256;
constexpr int lanes_of_pixel = 8, disparities_of_lane = 4;  // read at once
constexpr int pixels_of_block = winner_threads / lanes_of_pixel;

/// The smallest total of the paths, and where; of equal totals the first disparity wins.
struct CheapestPath {
  float total;
  int disparity;

  __device__ void take(float other_total, int other) {
    if (other_total > total || (other_total == total && other > disparity)) return;
    total = other_total;
    disparity = other;
  }
};

/// Of the sums of both directions at a pixel, by the lanes of a pixel; all of them get it.
__device__ CheapestPath cheapest_path(const float* forward, const float* backward, int count) {
  using Lane = LaneCosts<disparities_of_lane>;
  const int lane = static_cast<int>(threadIdx.x) % lanes_of_pixel;
  CheapestPath cheapest{INFINITY, count};
  for (int first = lane * disparities_of_lane; first < count; first += lanes_of_pixel * disparities_of_lane) {
    const Lane there = *reinterpret_cast<const Lane*>(forward + first);
    const Lane back = *reinterpret_cast<const Lane*>(backward + first);
    ROADSTEREO_UNROLL
    for (int k = 0; k < disparities_of_lane; ++k) {
      if (first + k < count) cheapest.take(there.at[k] + back.at[k], first + k);
    }
  }
  for (int mask = lanes_of_pixel / 2; mask > 0; mask /= 2) {
    const float total = __shfl_xor_sync(whole_warp, cheapest.total, mask);
    cheapest.take(total, __shfl_xor_sync(whole_warp, cheapest.disparity, mask));
  }
  return cheapest;
}

/// The winner with its fraction.
__device__ float with_fraction(const CheapestPath& winner, const float* forward, const float* backward,
                               const float* costs, int count, const RoadCost& road) {
  const int d = winner.disparity;
  const auto disparity = static_cast<float>(d);
  if (d == 0 || d + 1 >= count) return disparity;
  const auto total = [&](int at) { return forward[at] + backward[at]; };
  const PathWinner inside{disparity, total(d - 1), winner.total, total(d + 1), costs[d - 1], costs[d], costs[d + 1]};
  return disparity + fraction_of(inside, road);
}

__global__ void take_winners(CoarseVolume costs, CoarseVolume forward, CoarseVolume backward,
                             ImageView<const RoadCost> roads, const int* first_seen, ImageView<float> disparity) {
  begin_kernel();
  const int v = forward.first_row + static_cast<int>(blockIdx.y);
  const int wanted = static_cast<int>(blockIdx.x) * pixels_of_block + static_cast<int>(threadIdx.x) / lanes_of_pixel;
  const int u = min(wanted, forward.columns - 1);  // a warp stays whole
  const int seen = u - first_seen[v] + 1, count = min(seen, forward.disparities);
  const CheapestPath winner = cheapest_path(forward.pixel(u, v), backward.pixel(u, v), count);
  if (wanted != u || threadIdx.x % lanes_of_pixel != 0) return;
  disparity(u, v) = count > 0 ? with_fraction(winner, forward.pixel(u, v), backward.pixel(u, v), costs.pixel(u, v),
                                              count, roads(u, v))
                              : nanf("");
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
  launch("take_winners", take_winners, {dim3(blocks_for(costs.columns, pixels_of_block), rows), winner_threads}, stream,
         costs, forward, backward, roads, first_seen, disparity);
}

}  // namespace roadstereo::cuda

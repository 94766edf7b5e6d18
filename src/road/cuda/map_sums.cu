// Floor: 4 bytes and 12 operations on whole numbers a pixel: 0.9 MB and 3 million for 640×360. One thread solves for
// the roll angle, in double precision: some sines, and a few hundred operations a step of the descent.

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/last_block.hpp"
#include "core/cuda/launch.hpp"
#include "road/cuda/map_sums.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int rows_per_block = 8;
constexpr int row_sums = 6;
constexpr int map_sums = 10;
constexpr float disparity_steps = 1 << 14;

/// Shared memory of a block; the sums of its rows, or of all.
struct Shared {
  double rows[rows_per_block][row_sums];
  double total[sums_scratch(map_sums)];
  unsigned last;
};

/// A thread's part of a row, exact: disparities in steps of 2⁻¹⁴ px, columns in half pixels from the middle. Double
/// precision is slow on small GPUs. With columns and disparities below 2¹³ the sums of 256 pixels stay below 2⁶³.
struct LaneSums {
  int n = 0, u = 0;
  long long d = 0, uu = 0, ud = 0, dd = 0;

  __device__ void add(int half_columns, float disparity) {
    const long long steps = __float2int_rn(disparity * disparity_steps);
    ++n;
    u += half_columns;
    d += steps;
    uu += static_cast<long long>(half_columns) * half_columns;
    ud += half_columns * steps;
    dd += steps * steps;
  }
};

/// n, u, d, uu, ud, dd of a row: a warp adds them up, and its first lane makes the rest of them.
__device__ RawSums sum_row(const MaskedMap& map, int v, double* shared) {
  const double at_v = v - (map.disparity.height() - 1) / 2.0;
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  LaneSums lane_sums;
  for (int u = lane; u < map.disparity.width(); u += warp_lanes) {
    const float value = __ldg(map.disparity.row(v) + u);
    if (!(value == value) || (map.mask.data() != nullptr && map.mask(u, v) == 0)) continue;
    lane_sums.add(2 * u - (map.disparity.width() - 1), value);
  }
  constexpr double px = 1.0 / disparity_steps;
  const double own[row_sums] = {
      static_cast<double>(lane_sums.n),           lane_sums.u / 2.0,
      static_cast<double>(lane_sums.d) * px,      static_cast<double>(lane_sums.uu) / 4,
      static_cast<double>(lane_sums.ud) * px / 2, static_cast<double>(lane_sums.dd) * px * px};
  int first = 0, end = row_sums;
  const double sum = fold_lanes<warp_lanes / 2>(own, first, end);
  if (first < end) shared[first] = sum;
  __syncwarp();
  RawSums sums;
  sums.n = shared[0];
  sums.u = shared[1];
  sums.v = at_v * sums.n;
  sums.d = shared[2];
  sums.uu = shared[3];
  sums.uv = at_v * sums.u;
  sums.vv = at_v * sums.v;
  sums.ud = shared[4];
  sums.vd = at_v * sums.d;
  sums.dd = shared[5];
  return sums;
}

/// The rows' sums, by the last block.
__device__ RawSums add_rows(const RawSums* rows, int height, Shared& shared) {
  double own[map_sums] = {};
  for (int v = static_cast<int>(threadIdx.x); v < height; v += static_cast<int>(blockDim.x)) {
    const RawSums& s = rows[v];
    const double terms[map_sums] = {s.n, s.u, s.v, s.d, s.uu, s.uv, s.vv, s.ud, s.vd, s.dd};
    for (int i = 0; i < map_sums; ++i) own[i] += terms[i];
  }
  const double* t = block_sums(own, shared.total);
  RawSums sums;
  sums.n = t[0];
  sums.u = t[1];
  sums.v = t[2];
  sums.d = t[3];
  sums.uu = t[4];
  sums.uv = t[5];
  sums.vv = t[6];
  sums.ud = t[7];
  sums.vd = t[8];
  sums.dd = t[9];
  return sums;
}

__global__ void sum_map(MaskedMap map, RollFromSums how, RawSums* rows, unsigned* arrived, SolvedMap* solved,
                        SolvedMap* result) {
  begin_kernel();
  Shared& shared = *shared_memory<Shared>();
  const int own = static_cast<int>(threadIdx.x) / warp_lanes;
  const int v = static_cast<int>(blockIdx.x) * rows_per_block + own;
  if (v < map.disparity.height()) {
    const RawSums sums = sum_row(map, v, shared.rows[own]);
    if (threadIdx.x % warp_lanes == 0) rows[v] = sums;
  }
  if (!comes_last(arrived, gridDim.x, &shared.last)) return;
  const RawSums all = add_rows(rows, map.disparity.height(), shared);
  if (threadIdx.x != 0) return;
  const DeviationSums deviations =
      deviations_of(all, (map.disparity.width() - 1) / 2.0, (map.disparity.height() - 1) / 2.0);
  const SolvedMap found{solve_roll(deviations, how), all};
  *solved = found;
  *result = found;  // not read back: it lies in the host's memory
}

}  // namespace

void MapSums::run(const MaskedMap& map, const RollFromSums& how, StreamView stream) {
  reserve_cleared(arrived_, 1, stream.get());
  rows_.reserve(static_cast<std::size_t>(map.disparity.height()));
  launch("sum_map", sum_map,
         {blocks_for(map.disparity.height(), rows_per_block), rows_per_block * warp_lanes, sizeof(Shared)}, stream, map,
         how, rows_.data(), arrived_.data(), solved_.data(), result_.data());
}

}  // namespace roadstereo::cuda

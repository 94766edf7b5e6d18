// Floor: 4 bytes a pixel are read twice and 4 written, 2.8 MB for 640×360, and about 20 operations a pixel. Of the
// median of the sample, at most 48000 numbers, all blocks count the first digit and the last block the second.

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/block_select.hpp"
#include "core/cuda/last_block.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "road/cuda/disparity_transform.hpp"
#include "road/transformed.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 256;
constexpr int block_rows = 4;
constexpr int spread_sums = 6;  ///< two Spreads

/// Every `step`-th pixel of every `step`-th row.
struct Sample {
  float* heights;
  int step;
  int columns, rows;

  __device__ bool has(int at) const { return (at - step / 2) % step == 0; }
  __device__ int index(int at) const { return (at - step / 2) / step; }
};

/// The first of the rows of a block, and the column of a thread.
struct Pixel {
  __device__ Pixel()
      : u(static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x)), v(static_cast<int>(blockIdx.y) * block_rows) {}
  int u, v;
};

/// Tells `use(v, height)` how far the pixels of a thread lie above the road; they are read together. `lines` is shared
/// memory for the road's line in each of the rows.
template <class Use>
__device__ void for_each_height(const ImageView<const float>& disparity, const DisparityPlane& road, const Pixel& at,
                                RowLine* lines, Use use) {
  const int thread = static_cast<int>(threadIdx.x);
  if (thread < block_rows) lines[thread] = row_line(road, at.v + thread, 0);
  __syncthreads();
  if (at.u >= disparity.width()) return;
  float rows[block_rows];
  ROADSTEREO_UNROLL
  for (int k = 0; k < block_rows; ++k) rows[k] = __ldg(disparity.row(min(at.v + k, disparity.height() - 1)) + at.u);
  ROADSTEREO_UNROLL
  for (int k = 0; k < block_rows; ++k) {
    const int v = at.v + k;
    if (v < disparity.height()) use(v, above_road(rows[k], lines[k], at.u));
  }
}

/// Shared memory of measure_heights.
struct Measuring {
  float scratch[sums_scratch(1)];
  RowLine lines[block_rows];
  SelectScratch select;
  unsigned last;
};

/// Shared memory of shift_heights.
struct Shifting {
  double sums[sums_scratch(spread_sums)];
  RowLine lines[block_rows];
  unsigned last;
};

// Residuals as keys of two digits, in steps of 2⁻²⁰ px.
constexpr float steps_per_px = 1 << 20;
static_assert(spread_nearest_px * steps_per_px < 1 << 2 * DigitCounts::bits);

/// The key of the residual of a pixel, which is its height; false when it is not near the road or there is none.
__device__ bool residual_key(float height, std::uint32_t& key) {
  const float residual = fabsf(height);
  constexpr auto nearest = static_cast<float>(spread_nearest_px);
  key = static_cast<std::uint32_t>(fminf(residual, nearest) * steps_per_px);  // also of NaN, which does not count
  return residual <= nearest;
}

/// Median of the magnitudes of the residuals near the road, whose first digits all blocks have counted.
__device__ float median_near(const Sample& sample, const int* first_digits, SelectScratch& scratch) {
  const auto key = [&](int i, std::uint32_t& out) { return residual_key(sample.heights[i], out); };
  constexpr int at_once = 16;  // of the some 50 that a thread has in device memory
  const int count = sample.columns * sample.rows;
  const SelectedKey median = block_select<at_once>(count, key, MiddleRank{}, first_digits, scratch);
  return median.of > 0 ? static_cast<float>(median.key) / steps_per_px : 0;
}

/// Lowest height, number of valid disparities and counts of the sample; the last block derives δt and the limit of the
/// spread, and clears what blocks have counted: nothing is left where the next launch fails.
__global__ void measure_heights(ImageView<const float> disparity, PlaneSource source, TransformOffset offset,
                                Sample sample, DisparityTransform::State* state) {
  begin_kernel();
  Measuring& shared = *shared_memory<Measuring>();
  const DisparityPlane road = source.get();
  const Pixel at;
  const bool of_sample = at.u < disparity.width() && sample.has(at.u);
  float lowest = INFINITY;
  int valid = 0;
  for_each_height(disparity, road, at, shared.lines, [&](int v, float height) {
    if (of_sample && sample.has(v)) {
      sample.heights[sample.index(v) * sample.columns + sample.index(at.u)] = height;
      std::uint32_t key = 0;
      if (residual_key(height, key)) atomicAdd(&state->first_digits[key >> DigitCounts::bits], 1);
    }
    if (!(height == height)) return;
    ++valid;
    lowest = height < lowest ? height : lowest;
  });
  lowest = block_best(lowest, Least{}, shared.scratch);
  const int own[1] = {valid};
  const int valid_of_block = *block_sums(own, reinterpret_cast<int*>(shared.scratch));
  if (threadIdx.x == 0) {
    atomicMax(&state->lowest, ~key_of(lowest));
    atomicAdd(&state->valid, valid_of_block);
  }
  if (!comes_last(&state->arrived, gridDim.x * gridDim.y, &shared.last)) return;
  const float median = median_near(sample, state->first_digits, shared.select);
  for (int i = static_cast<int>(threadIdx.x); i < DigitCounts::bins; i += static_cast<int>(blockDim.x)) {
    state->first_digits[i] = 0;
  }
  if (threadIdx.x != 0) return;
  state->found.delta_t = offset.given < 0 ? derived_delta_t(value_of(~state->lowest), offset.least) : offset.given;
  state->found.limit = static_cast<float>(spread_limit(median));
  state->found.valid = state->valid;
  state->lowest = 0;
  state->valid = 0;
}

/// The statistics, from the sums of all blocks.
__device__ void finish(const double* sums, int blocks, Shifting& shared, const DisparityTransform::Heights& heights,
                       TransformStatistics& statistics) {
  double own[spread_sums] = {};
  for (int block = static_cast<int>(threadIdx.x); block < blocks; block += static_cast<int>(blockDim.x)) {
    for (int i = 0; i < spread_sums; ++i) own[i] += sums[block * spread_sums + i];
  }
  const double* total = block_sums(own, shared.sums);
  if (threadIdx.x != 0) return;
  const Spread all{total[0], total[1], total[2]}, road{total[3], total[4], total[5]};
  statistics = {heights.delta_t, road.deviation(), all.deviation(), all.n > 0 ? road.n / all.n : 0, heights.valid};
}

/// Writes the transformed map and adds up its spread: in single precision over a block, in double over the blocks.
__global__ void shift_heights(ImageView<const float> disparity, PlaneSource source, ImageView<float> transformed,
                              DisparityTransform::State* state, double* sums, TransformStatistics* statistics) {
  begin_kernel();
  Shifting& shared = *shared_memory<Shifting>();
  const DisparityPlane plane = source.get();
  const DisparityTransform::Heights heights = state->found;
  const auto delta_t = static_cast<float>(heights.delta_t);
  const Pixel at;
  float own[spread_sums] = {};
  for_each_height(disparity, plane, at, shared.lines, [&](int v, float height) {
    const float value = height + delta_t;
    transformed(at.u, v) = value;
    const float residual = value - delta_t, square = residual * residual;
    if (!(residual == residual)) return;
    own[0] += 1;
    own[1] += residual;
    own[2] += square;
    if (fabsf(residual) > heights.limit) return;
    own[3] += 1;
    own[4] += residual;
    own[5] += square;
  });
  const float* total = block_sums(own, reinterpret_cast<float*>(shared.sums));
  const int block = static_cast<int>(blockIdx.y * gridDim.x + blockIdx.x);
  const int i = static_cast<int>(threadIdx.x);
  if (i < spread_sums) sums[block * spread_sums + i] = total[i];
  if (!comes_last(&state->arrived, gridDim.x * gridDim.y, &shared.last)) return;
  finish(sums, static_cast<int>(gridDim.x * gridDim.y), shared, heights, *statistics);
}

/// How many of 0 … size − 1 the sample takes.
int sampled(int size, int step) {
  return size > step / 2 ? (size - step / 2 + step - 1) / step : 0;
}

}  // namespace

void DisparityTransform::run(ImageView<const float> disparity, const PlaneSource& road, const TransformOffset& offset,
                             ImageView<float> transformed, StreamView stream) {
  reserve_cleared(state_, 1, stream.get());
  const int step = spread_step(static_cast<double>(disparity.width()) * disparity.height());
  const int columns = sampled(disparity.width(), step), rows = sampled(disparity.height(), step);
  sample_.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const dim3 grid(blocks_for(disparity.width(), block_columns), blocks_for(disparity.height(), block_rows));
  sums_.reserve(static_cast<std::size_t>(grid.x) * grid.y * spread_sums);
  launch("measure_heights", measure_heights, {grid, block_columns, sizeof(Measuring)}, stream, disparity, road, offset,
         Sample{sample_.data(), step, columns, rows}, state_.data());
  launch("shift_heights", shift_heights, {grid, block_columns, sizeof(Shifting)}, stream, disparity, road, transformed,
         state_.data(), sums_.data(), result_.data());
}

}  // namespace roadstereo::cuda

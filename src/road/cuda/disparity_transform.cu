// Floor: 4 bytes a pixel are read twice and 4 written, 2.8 MB for 640×360, and about 20 operations in double precision
// a pixel. The median of the sample takes four passes of one block over at most 48000 numbers.

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

/// Tells `use(v, height)` how far the pixels of a thread lie above the road; they are read together.
template <class Use>
__device__ void for_each_height(const ImageView<const float>& disparity, const DisparityPlane& road, const Pixel& at,
                                Use use) {
  if (at.u >= disparity.width()) return;
  float rows[block_rows];
  ROADSTEREO_UNROLL
  for (int k = 0; k < block_rows; ++k) rows[k] = __ldg(disparity.row(min(at.v + k, disparity.height() - 1)) + at.u);
  ROADSTEREO_UNROLL
  for (int k = 0; k < block_rows; ++k) {
    const int v = at.v + k;
    if (v < disparity.height()) use(v, above_road(rows[k], road_at_row(road.a0, road.a1, v), road.a2, at.u));
  }
}

/// Shared memory of both kernels.
struct Shared {
  double sums[sums_scratch(spread_sums)];
  SelectScratch select;
  unsigned last;
};

/// Median of the magnitudes of the residuals near the road. In steps of 2⁻³⁰ px, which is exact for residuals to a
/// whole δt, and spreads the keys over their range.
__device__ double median_near(const Sample& sample, double delta_t, SelectScratch& scratch) {
  constexpr float steps = 1U << 30;
  const auto key = [&](int i, std::uint32_t& out) {
    const float value = sample.heights[i] + static_cast<float>(delta_t);
    const auto residual = static_cast<float>(fabs(value - delta_t));
    constexpr auto nearest = static_cast<float>(spread_nearest_px);
    out = static_cast<std::uint32_t>(fminf(residual, nearest) * steps);  // also of NaN, which does not count
    return residual <= nearest;
  };
  constexpr int at_once = 16;  // of the some 50 that a thread has in device memory
  const SelectedKey median = block_select<at_once>(sample.columns * sample.rows, key, MiddleRank{}, scratch);
  return median.of > 0 ? static_cast<double>(median.key) / steps : 0;
}

/// Lowest height and number of valid disparities; the last block derives δt and the limit of the spread.
__global__ void measure_heights(ImageView<const float> disparity, PlaneSource source, TransformOffset offset,
                                Sample sample, DisparityTransform::State* state) {
  Shared& shared = *shared_memory<Shared>();
  const DisparityPlane road = source.get();
  const Pixel at;
  const bool of_sample = at.u < disparity.width() && sample.has(at.u);
  float lowest = INFINITY;
  int valid = 0;
  for_each_height(disparity, road, at, [&](int v, float height) {
    if (of_sample && sample.has(v)) sample.heights[sample.index(v) * sample.columns + sample.index(at.u)] = height;
    if (!(height == height)) return;
    ++valid;
    lowest = height < lowest ? height : lowest;
  });
  lowest = block_best(lowest, Least{}, reinterpret_cast<float*>(shared.sums));
  const int own[1] = {valid};
  const int valid_of_block = *block_sums(own, reinterpret_cast<int*>(shared.sums));
  if (threadIdx.x == 0) {
    atomicMax(&state->lowest, ~key_of(lowest));
    atomicAdd(&state->valid, valid_of_block);
  }
  if (!comes_last(&state->arrived, gridDim.x * gridDim.y, &shared.last)) return;
  const double delta_t = offset.given < 0 ? derived_delta_t(value_of(~state->lowest), offset.least) : offset.given;
  const double median = median_near(sample, delta_t, shared.select);
  if (threadIdx.x != 0) return;
  state->delta_t = delta_t;
  state->limit = spread_limit(median);
}

/// The statistics, from the sums of all blocks.
__device__ void finish(const double* sums, int blocks, Shared& shared, DisparityTransform::State& state,
                       TransformStatistics& statistics) {
  double own[spread_sums] = {};
  for (int block = static_cast<int>(threadIdx.x); block < blocks; block += static_cast<int>(blockDim.x)) {
    for (int i = 0; i < spread_sums; ++i) own[i] += sums[block * spread_sums + i];
  }
  const double* total = block_sums(own, shared.sums);
  if (threadIdx.x != 0) return;
  const Spread all{total[0], total[1], total[2]}, road{total[3], total[4], total[5]};
  statistics = {state.delta_t, road.deviation(), all.deviation(), all.n > 0 ? road.n / all.n : 0, state.valid};
  state.lowest = 0;
  state.valid = 0;
}

/// Writes the transformed map and adds up its spread.
__global__ void shift_heights(ImageView<const float> disparity, PlaneSource source, ImageView<float> transformed,
                              DisparityTransform::State* state, double* sums, TransformStatistics* statistics) {
  Shared& shared = *shared_memory<Shared>();
  const DisparityPlane plane = source.get();
  const double delta_t = state->delta_t, limit = state->limit;
  const Pixel at;
  Spread all{0, 0, 0}, road{0, 0, 0};
  for_each_height(disparity, plane, at, [&](int v, float height) {
    const float value = height + static_cast<float>(delta_t);
    transformed(at.u, v) = value;
    const double residual = value - delta_t;
    if (!(residual == residual)) return;
    all.add(residual);
    if (fabs(residual) <= limit) road.add(residual);
  });
  const double own[spread_sums] = {all.n, all.sum, all.squares, road.n, road.sum, road.squares};
  const double* total = block_sums(own, shared.sums);
  const int block = static_cast<int>(blockIdx.y * gridDim.x + blockIdx.x);
  const int i = static_cast<int>(threadIdx.x);
  if (i < spread_sums) sums[block * spread_sums + i] = total[i];
  if (!comes_last(&state->arrived, gridDim.x * gridDim.y, &shared.last)) return;
  finish(sums, static_cast<int>(gridDim.x * gridDim.y), shared, *state, *statistics);
}

/// How many of 0 … size − 1 the sample takes.
int sampled(int size, int step) {
  return size > step / 2 ? (size - step / 2 + step - 1) / step : 0;
}

}  // namespace

void DisparityTransform::run(ImageView<const float> disparity, const PlaneSource& road, const TransformOffset& offset,
                             ImageView<float> transformed, cudaStream_t stream) {
  if (state_.capacity() == 0) {
    state_.reserve(1);
    ROADSTEREO_CUDA(cudaMemsetAsync(state_.data(), 0, sizeof(State), stream));
  }
  const int step = spread_step(static_cast<double>(disparity.width()) * disparity.height());
  const int columns = sampled(disparity.width(), step), rows = sampled(disparity.height(), step);
  sample_.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const LaunchShape shape{
      dim3(blocks_for(disparity.width(), block_columns), blocks_for(disparity.height(), block_rows)), block_columns,
      sizeof(Shared)};
  sums_.reserve(static_cast<std::size_t>(shape.grid.x) * shape.grid.y * spread_sums);
  launch(measure_heights, shape, stream, disparity, road, offset, Sample{sample_.data(), step, columns, rows},
         state_.data());
  launch(shift_heights, shape, stream, disparity, road, transformed, state_.data(), sums_.data(), result_.data());
}

}  // namespace roadstereo::cuda

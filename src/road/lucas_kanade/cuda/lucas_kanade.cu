// Floor: 12 bytes a pixel, and of each of the (2 r + 1)² samples of its window 16 bytes of shared memory and 16
// operations: for 640×360 and r = 10 2.8 MB and 1.6 billion operations. A tile of 32×8 pixels reads a border of r, too:
// six times its pixels.

#include "core/cuda/launch.hpp"
#include "road/lucas_kanade/cuda/lucas_kanade.hpp"
#include "road/row_shift.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int tile_columns = 32, tile_rows = 8;

/// What is aligned.
struct Maps {
  TransformedPair pair;
  ImageView<const float> disparity;
};

/// A row that is prefiltered where it is read.
struct PrefilteredRow {
  const std::int16_t* row;

  __device__ float operator[](int u) const { return prefiltered(row, u); }
};

__device__ AlignmentSample sample_at(const Maps& maps, int u, int v, float centre) {
  if (u < 0 || u >= maps.disparity.width() || v < 0 || v >= maps.disparity.height()) return {};
  const TransformedPair& pair = maps.pair;
  const int first = pair.first_column != nullptr ? __ldg(pair.first_column + v) : 0;
  const float residual = without_shift(__ldg(&maps.disparity(u, v)), shift_line(pair.shift, v), u);
  return alignment_sample(PrefilteredRow{pair.reference.row(v)}, PrefilteredRow{pair.target.row(v)}, first,
                          maps.disparity.width(), u, residual, centre);
}

/// Single precision: samples are relative to the level at the middle of the tile.
__device__ float tile_centre(const Maps& maps, int left, int top) {
  const int u = min(left + tile_columns / 2, maps.disparity.width() - 1);
  const int v = min(top + tile_rows / 2, maps.disparity.height() - 1);
  constexpr float prefilter_gain = 9;
  return prefilter_gain * static_cast<float>(maps.pair.reference(u, v));
}

__device__ void add(const AlignmentSample& sample, AlignmentSums<float>& sums) {
  sums.n += sample.weight;
  sums.t += sample.target;
  sums.g += sample.gradient;
  sums.r += sample.difference;
  sums.tt += sample.target * sample.target;
  sums.tg += sample.target * sample.gradient;
  sums.tr += sample.target * sample.difference;
  sums.gg += sample.gradient * sample.gradient;
  sums.gr += sample.gradient * sample.difference;
  sums.rr += sample.difference * sample.difference;
}

__global__ void align(Maps maps, int radius, AlignmentSettings settings, ImageView<float> aligned) {
  const int left = static_cast<int>(blockIdx.x) * tile_columns, top = static_cast<int>(blockIdx.y) * tile_rows;
  const int columns = tile_columns + 2 * radius, rows = tile_rows + 2 * radius;
  auto* samples = shared_memory<AlignmentSample>();
  const float centre = tile_centre(maps, left, top);
  for (int y = static_cast<int>(threadIdx.y); y < rows; y += tile_rows) {
    for (int x = static_cast<int>(threadIdx.x); x < columns; x += tile_columns) {
      samples[y * columns + x] = sample_at(maps, left - radius + x, top - radius + y, centre);
    }
  }
  __syncthreads();
  const int u = left + static_cast<int>(threadIdx.x), v = top + static_cast<int>(threadIdx.y);
  if (u >= aligned.width() || v >= aligned.height()) return;
  AlignmentSums<float> sums{};
  for (int y = 0; y <= 2 * radius; ++y) {
    const AlignmentSample* row =
        samples + (static_cast<int>(threadIdx.y) + y) * columns + static_cast<int>(threadIdx.x);
    for (int x = 0; x <= 2 * radius; ++x) add(row[x], sums);
  }
  const float full_scale = 1 - shift_line(maps.pair.shift, v).slope;  // d disparity / d residual
  aligned(u, v) = __ldg(&maps.disparity(u, v)) + full_scale * alignment_shift(sums, settings);
}

}  // namespace

void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, int radius,
                  const AlignmentSettings& settings, ImageView<float> aligned, StreamView stream) {
  const dim3 block(tile_columns, tile_rows);
  const dim3 grid(blocks_for(aligned.width(), tile_columns), blocks_for(aligned.height(), tile_rows));
  const std::size_t bytes = static_cast<std::size_t>(tile_columns + 2 * radius) *
                            static_cast<std::size_t>(tile_rows + 2 * radius) * sizeof(AlignmentSample);
  launch("lucas_kanade", align, {grid, block, bytes}, stream, Maps{pair, disparity}, radius, settings, aligned);
}

}  // namespace roadstereo::cuda

// Floor: a pixel of the pair is read once (2 to 16 bytes) and written once (4 bytes), with 2 to 8 operations: 1.4 MB
// for 640×360 in 8-bit grey, half a microsecond of an H200's memory.

#include "core/cuda/grey.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 32, block_rows = 8;
constexpr int columns_each = 4;

enum Finding : int { left_varies = 1, right_varies = 2, differ = 4 };
enum Vote : int { found, ended, vote_count };

struct GreyPair {
  DeviceFrame left_frame, right_frame;
  ImageView<std::int16_t> left, right;
};

/// The samples of a pixel, as they are read: what is made of them waits until others are on their way too.
struct Samples {
  unsigned first, second, third;  ///< the last two of colours only
};

template <class Sample>
__device__ Samples read_samples(const DeviceFrame& frame, int u, int v) {
  const auto* row = static_cast<const unsigned char*>(frame.data) + v * frame.stride_bytes;
  const Sample* pixel = reinterpret_cast<const Sample*>(row) + static_cast<std::ptrdiff_t>(u) * frame.channels;
  const bool colours = frame.channels != 1;
  return {__ldg(pixel), colours ? __ldg(pixel + 1) : 0U, colours ? __ldg(pixel + 2) : 0U};
}

__device__ Samples samples_at(const DeviceFrame& frame, int u, int v) {
  return frame.sample_bytes == 2 ? read_samples<unsigned short>(frame, u, v) : read_samples<unsigned char>(frame, u, v);
}

__device__ std::int16_t level_of(const DeviceFrame& frame, const Samples& samples) {
  if (frame.channels == 1) return grey_level(frame.weights, static_cast<float>(samples.first));
  return grey_level(frame.weights, static_cast<float>(samples.first), static_cast<float>(samples.second),
                    static_cast<float>(samples.third));
}

/// A pixel of both images.
struct PixelPair {
  Samples left, right;
};

__device__ PixelPair read_pair(const GreyPair& pair, int u, int v) {
  return {samples_at(pair.left_frame, u, v), samples_at(pair.right_frame, u, v)};
}

/// Converts the pixels of this thread and returns what they show, against the first ones.
__device__ int convert_pixels(const GreyPair& pair, const PixelPair& first) {
  const int v = static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
  const int begin = static_cast<int>(blockIdx.x) * columns_each * block_columns + static_cast<int>(threadIdx.x);
  if (v >= pair.left.height() || begin >= pair.left.width()) return 0;
  PixelPair pixels[columns_each];
  ROADSTEREO_UNROLL
  for (int k = 0; k < columns_each; ++k) {
    const int u = begin + k * block_columns;
    pixels[k] = read_pair(pair, u < pair.left.width() ? u : begin, v);
  }
  const std::int16_t first_left = level_of(pair.left_frame, first.left);
  const std::int16_t first_right = level_of(pair.right_frame, first.right);
  int shown = 0;
  ROADSTEREO_UNROLL
  for (int k = 0; k < columns_each; ++k) {
    const int u = begin + k * block_columns;
    if (u >= pair.left.width()) break;
    const std::int16_t left = level_of(pair.left_frame, pixels[k].left);
    const std::int16_t right = level_of(pair.right_frame, pixels[k].right);
    pair.left(u, v) = left;
    pair.right(u, v) = right;
    shown |= (left != first_left ? left_varies : 0) | (right != first_right ? right_varies : 0) |
             (left != right ? differ : 0);
  }
  return shown;
}

__device__ bool warp_has(int shown, Finding what) {
  return __any_sync(0xFFFFFFFFU, (shown & what) != 0) != 0;
}

/// The last block of all tells the host, and clears the votes for the next launch.
__device__ void report(int shown, int* votes, int first_left, int first_right, PairFindings* findings) {
  if (shown != 0) atomicOr(&votes[found], shown);
  __threadfence();
  const auto blocks = static_cast<int>(gridDim.x * gridDim.y);
  if (atomicAdd(&votes[ended], 1) != blocks - 1) return;
  __threadfence();
  const int all = atomicOr(&votes[found], 0);
  *findings = {all & left_varies ? 1 : 0, all & right_varies ? 1 : 0, all & differ ? 1 : 0, first_left, first_right};
  votes[found] = 0;
  votes[ended] = 0;
}

__global__ void pair_to_grey(GreyPair pair, int* votes, PairFindings* findings) {
  begin_kernel();
  int* of_block = shared_memory<int>();
  const bool first_thread = threadIdx.x == 0 && threadIdx.y == 0;
  if (first_thread) *of_block = 0;
  __syncthreads();
  const PixelPair first = read_pair(pair, 0, 0);
  const int shown = convert_pixels(pair, first);
  const int of_warp = (warp_has(shown, left_varies) ? left_varies : 0) |
                      (warp_has(shown, right_varies) ? right_varies : 0) | (warp_has(shown, differ) ? differ : 0);
  if (threadIdx.x == 0 && of_warp != 0) atomicOr(of_block, of_warp);
  __syncthreads();
  if (!first_thread) return;
  report(*of_block, votes, level_of(pair.left_frame, first.left), level_of(pair.right_frame, first.right), findings);
}

}  // namespace

void PairToGrey::convert(const DeviceFrame& left_frame, const DeviceFrame& right_frame, ImageView<std::int16_t> left,
                         ImageView<std::int16_t> right, StreamView stream) {
  findings_.reserve(1);
  reserve_cleared(votes_, vote_count, stream.get());
  const dim3 grid(blocks_for(left.width(), block_columns * columns_each), blocks_for(left.height(), block_rows));
  launch("pair_to_grey", pair_to_grey, {grid, dim3(block_columns, block_rows), sizeof(int)}, stream,
         GreyPair{left_frame, right_frame, left, right}, votes_.data(), findings_.data());
}

}  // namespace roadstereo::cuda

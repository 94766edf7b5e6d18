// Floor: a seventh of the pair is read to measure the steps. Where it is compressed half of its pixels are read and
// written twice: 2.8 MB for 640×360, a microsecond of an H200's memory.

#include "core/cuda/deblocking.hpp"
#include "core/cuda/last_block.hpp"
#include "core/cuda/launch.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_threads = 256;

struct Pair {
  ImageView<std::int16_t> left, right;

  __device__ ImageView<std::int16_t> image() const { return blockIdx.y == 0 ? left : right; }
};

struct Sums {
  int between, beside;
  unsigned last;
};

/// Adds the steps at one sampled border to `sums`.
__device__ void add_sample(const ImageView<std::int16_t>& image, const BlockStepSamples& samples, int index,
                           Sums& sums) {
  int between = 0, beside = 0;
  if (index < samples.across()) {
    const std::int16_t* const row = image.row(1 + index / samples.borders_across * BlockStepSamples::step);
    const int u = jpeg_block * (1 + index % samples.borders_across);
    add_steps(row[u - 2], row[u - 1], row[u], row[u + 1], between, beside);
  } else {
    const int of_columns = index - samples.across();
    const int u = of_columns % samples.columns * BlockStepSamples::step;
    const int v = jpeg_block * (1 + of_columns / samples.columns);
    add_steps(image(u, v - 2), image(u, v - 1), image(u, v), image(u, v + 1), between, beside);
  }
  atomicAdd(&sums.between, between);
  atomicAdd(&sums.beside, beside);
}

__global__ void measure_block_steps(Pair pair, BlockStepSamples samples, DeblockedImage* images, unsigned* arrived,
                                    double* excess) {
  begin_kernel();
  Sums& sums = *shared_memory<Sums>();
  if (threadIdx.x == 0) sums.between = sums.beside = 0;
  __syncthreads();
  const int index = static_cast<int>(blockIdx.x * block_threads + threadIdx.x);
  if (index < samples.count()) add_sample(pair.image(), samples, index, sums);
  __syncthreads();
  DeblockedImage& image = images[blockIdx.y];
  if (threadIdx.x == 0) {
    atomicAdd(&image.between, static_cast<unsigned long long>(sums.between));
    atomicAdd(&image.beside, static_cast<unsigned long long>(sums.beside));
  }
  if (!comes_last(&arrived[blockIdx.y], gridDim.x, &sums.last) || threadIdx.x != 0) return;
  const BlockSteps steps{static_cast<std::int64_t>(atomicAdd(&image.between, 0ULL)),
                         static_cast<std::int64_t>(atomicAdd(&image.beside, 0ULL))};
  image = {0, 0, deblocking_strength(steps, samples.count())};
  excess[blockIdx.y] = steps.excess();
}

/// A thread a border and row: consecutive threads take the borders of a row.
__global__ void smooth_steps_across(Pair pair, const DeblockedImage* images) {
  begin_kernel();
  const ImageView<std::int16_t> image = pair.image();
  const int strength = images[blockIdx.y].strength, borders = (image.width() - 2) / jpeg_block;
  const int index = static_cast<int>(blockIdx.x * block_threads + threadIdx.x);
  if (strength == 0 || index >= borders * image.height()) return;
  std::int16_t* const pixel = image.row(index / borders) + jpeg_block * (1 + index % borders);
  smooth_step(pixel[-2], pixel[-1], pixel[0], pixel[1], strength);
}

/// A thread a border and column.
__global__ void smooth_steps_down(Pair pair, const DeblockedImage* images) {
  begin_kernel();
  const ImageView<std::int16_t> image = pair.image();
  const int strength = images[blockIdx.y].strength, borders = (image.height() - 2) / jpeg_block;
  const int index = static_cast<int>(blockIdx.x * block_threads + threadIdx.x);
  if (strength == 0 || index >= borders * image.width()) return;
  const int u = index % image.width(), v = jpeg_block * (1 + index / image.width());
  smooth_step(image(u, v - 2), image(u, v - 1), image(u, v), image(u, v + 1), strength);
}

}  // namespace

void PairDeblocking::run(ImageView<std::int16_t> left, ImageView<std::int16_t> right, bool smooth, StreamView stream) {
  const BlockStepSamples samples(left.width(), left.height());
  excess_.reserve(2);
  reserve_cleared(images_, 2, stream.get());
  reserve_cleared(arrived_, 2, stream.get());
  const Pair pair{left, right};
  const auto grid = [](int count) { return dim3(blocks_for(count, block_threads), 2); };
  launch("measure_block_steps", measure_block_steps, {grid(samples.count()), dim3(block_threads), sizeof(Sums)}, stream,
         pair, samples, images_.data(), arrived_.data(), excess_.data());
  if (!smooth) return;
  launch("smooth_steps_across", smooth_steps_across,
         {grid(samples.borders_across * left.height()), dim3(block_threads), 0}, stream, pair, images_.data());
  launch("smooth_steps_down", smooth_steps_down, {grid(samples.borders_down * left.width()), dim3(block_threads), 0},
         stream, pair, images_.data());
}

}  // namespace roadstereo::cuda

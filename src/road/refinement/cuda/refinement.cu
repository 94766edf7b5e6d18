// Floor: 24 bytes a pixel, and of each of its 25 neighbours (radius 12, step 6) 12 bytes of shared memory and 22
// operations: 1.4 MB and 32 million operations for every second pixel of 640×360, for each of two passes. A tile of
// 32×16 pixels reads its border of 8 too, of 16 in the second pass: three and eight times its pixels.

#include <cmath>

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "road/refinement/cuda/measured_maps.hpp"
#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/cuda/slopes.hpp"
#include "road/refinement/smoothing_bias.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int tile_columns = 32, thread_rows = 8;
constexpr int rows_at_once = 4;  // of a thread, when a tile is read

/// The pixels of a tile and a border around it in shared memory: the road's line of each row, three planes of numbers.
struct Tile {
  RowLine* lines;
  float* numbers;
  int left, top;  ///< of the border, pixels of the map
  int columns, rows;

  __device__ int size() const { return columns * rows; }
  __device__ RowLine road(int v) const { return lines[v - top]; }
  __device__ MeasuredHeight operator()(int u, int v) const {
    const float* at = numbers + (v - top) * columns + (u - left);
    return {at[0], at[size()], at[2 * size()]};
  }
  __device__ void fill(const MeasuredMaps& maps, const VarianceBounds& bounds) const {
    const int thread = static_cast<int>(threadIdx.y) * tile_columns + static_cast<int>(threadIdx.x);
    for (int y = thread; y < rows; y += tile_columns * thread_rows) lines[y] = maps.road_line(top + y);
    __syncthreads();
    for (int x = static_cast<int>(threadIdx.x); x < columns; x += tile_columns) {
      for (int y = static_cast<int>(threadIdx.y); y < rows; y += rows_at_once * thread_rows) {
        fill_rows(maps, bounds, x, y);
      }
    }
    __syncthreads();
  }

 private:
  /// Pixels of a column, from row `first` on.
  __device__ void fill_rows(const MeasuredMaps& maps, const VarianceBounds& bounds, int x, int first) const {
    MapPixel pixels[rows_at_once];
    ROADSTEREO_UNROLL
    for (int k = 0; k < rows_at_once; ++k) pixels[k] = read_pixel(maps, left + x, top + first + k * thread_rows);
    ROADSTEREO_UNROLL
    for (int k = 0; k < rows_at_once; ++k) {
      const int y = first + k * thread_rows;
      if (y >= rows) break;
      const MeasuredHeight pixel = measured_at(maps, pixels[k], lines[y], bounds, left + x, top + y);
      float* at = numbers + y * columns + x;
      at[0] = pixel.value;
      at[size()] = pixel.precision;
      at[2 * size()] = pixel.variance;
    }
  }
};

/// Where a window is too wide for shared memory.
struct Untiled {
  const MeasuredMaps& maps;
  const VarianceBounds& bounds;

  __device__ RowLine road(int v) const { return maps.road_line(v); }
  __device__ MeasuredHeight operator()(int u, int v) const {
    return measured_at(maps, read_pixel(maps, u, v), maps.road_line(v), bounds, u, v);
  }
};

/// Quotient where a last bit does not matter.
__device__ float quotient(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fdividef(a, b);
#else
  return a / b;
#endif
}

template <class Pixels>
__device__ RefinedPixel refine_pixel(const MeasuredMaps& maps, const SlopeMaps& slopes, const Pixels& pixels,
                                     const RefinementSettings& settings, int u, int v) {
  const float disparity = __ldg(&maps.disparity(u, v));  // loaded while the window is summed
  const bool on_slope = settings.pass.on_slope;
  const float across = on_slope ? __ldg(&slopes.across(u, v)) : 0, down = on_slope ? __ldg(&slopes.down(u, v)) : 0;
  const MeasuredHeight centre = pixels(u, v);
  float weights = 0, away = 0, squares = 0, expected_squares = 0;
  for (int dv = -settings.pass.radius; dv <= settings.pass.radius; dv += settings.pass.step) {
    for (int du = -settings.pass.radius; du <= settings.pass.radius; du += settings.pass.step) {
      const MeasuredHeight other = pixels(u + du, v + dv);
      const float expected_there = centre.value + down * static_cast<float>(dv) + across * static_cast<float>(du);
      const float difference = other.value - expected_there;
      const float joint = settings.pass.mean.reach2 * (other.variance + centre.variance);
      const float agreement = fmaxf(0.0F, 1 - quotient(difference * difference, joint));
      const float share = agreement * agreement;
      const float weight = share * other.precision;
      const float weighted = weight * difference;
      weights += weight;
      away += weighted;
      squares += weighted * difference;
      expected_squares += other.precision > 0 ? share : 0;
    }
  }
  const float shift = weights > 0 ? away / weights : 0;
  const float mean = centre.value + shift;
  const float scatter = weights > 0 ? (squares - expected_squares) / weights : 0;
  const float excess = fmaxf(0.0F, scatter - shift * shift);
  const float averaged = fmaxf(centre.precision, weights * settings.pass.mean.share);
  const float precision = averaged / (averaged * excess + 1);
  const float road = pixels.road(v).at(static_cast<float>(u));
  return refined_pixel(disparity, mean, precision, road, settings.pass.is_last, settings.worst_sigma, nanf(""));
}

template <int rows_each>
__global__ void refine_tiles(MeasuredMaps maps, SlopeMaps slopes, RefinementSettings settings, ImageView<float> refined,
                             ImageView<float> error) {
  begin_kernel();
  const int left = static_cast<int>(blockIdx.x) * tile_columns;
  const int top = static_cast<int>(blockIdx.y) * thread_rows * rows_each;
  const int border = settings.pass.radius;
  const int rows = thread_rows * rows_each + 2 * border;
  auto* lines = shared_memory<RowLine>();
  const Tile tile{lines, reinterpret_cast<float*>(lines + rows), left - border, top - border, tile_columns + 2 * border,
                  rows};
  tile.fill(maps, settings.bounds);
  const int u = left + static_cast<int>(threadIdx.x);
  for (int k = 0; k < rows_each; ++k) {
    const int v = top + k * thread_rows + static_cast<int>(threadIdx.y);
    if (u >= refined.width() || v >= refined.height()) continue;
    const RefinedPixel pixel = refine_pixel(maps, slopes, tile, settings, u, v);
    refined(u, v) = pixel.disparity;
    error(u, v) = pixel.error;
  }
}

__global__ void refine_untiled(MeasuredMaps maps, SlopeMaps slopes, RefinementSettings settings,
                               ImageView<float> refined, ImageView<float> error) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x * tile_columns + threadIdx.x);
  const int v = static_cast<int>(blockIdx.y * thread_rows + threadIdx.y);
  if (u >= refined.width() || v >= refined.height()) return;
  const RefinedPixel pixel = refine_pixel(maps, slopes, Untiled{maps, settings.bounds}, settings, u, v);
  refined(u, v) = pixel.disparity;
  error(u, v) = pixel.error;
}

/// Adds the error of smoothing to the standard errors.
__global__ void add_smoothing_error(ImageView<const float> disparity, int reach, ImageView<float> sigma) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x * tile_columns + threadIdx.x) + reach;
  const int v = static_cast<int>(blockIdx.y * thread_rows + threadIdx.y) + reach;
  if (u >= disparity.width() - reach || v >= disparity.height() - reach) return;
  const float two_across = __ldg(&disparity(u - reach, v)) + __ldg(&disparity(u + reach, v));
  const float two_down = __ldg(&disparity(u, v - reach)) + __ldg(&disparity(u, v + reach));
  sigma(u, v) = with_smoothing_bias(sigma(u, v), __ldg(&disparity(u, v)), two_across, two_down);
}

std::size_t tile_bytes(int rows, int border) {
  const auto all_rows = static_cast<std::size_t>(rows + 2 * border);
  return all_rows * (sizeof(RowLine) + 3 * static_cast<std::size_t>(tile_columns + 2 * border) * sizeof(float));
}

}  // namespace

void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, const DisparityPlane& road,
                        const RefinementSettings& settings, const SlopeMaps& slopes, ImageView<float> refined,
                        ImageView<float> error, StreamView stream) {
  constexpr unsigned few_blocks = 256;  // about two a multiprocessor: then a thread's way through its pixels counts
  const MeasuredMaps maps{disparity, variance, road};
  const dim3 block(tile_columns, thread_rows);
  if (settings.pass.on_slope) find_slopes(maps, settings.pass.slope, settings.bounds, slopes, stream);
  const auto grid = [&](int rows) {
    return dim3(blocks_for(refined.width(), tile_columns), blocks_for(refined.height(), rows));
  };
  const dim3 of_two_rows = grid(2 * thread_rows);
  const int rows_each = of_two_rows.x * of_two_rows.y < few_blocks ? 1 : 2;
  const std::size_t bytes = tile_bytes(rows_each * thread_rows, settings.pass.radius);
  if (bytes <= max_shared_bytes) {
    launch("refine_tiles", rows_each == 1 ? refine_tiles<1> : refine_tiles<2>,
           {grid(rows_each * thread_rows), block, bytes}, stream, maps, slopes, settings, refined, error);
  } else {
    launch("refine_untiled", refine_untiled, {grid(thread_rows), block}, stream, maps, slopes, settings, refined,
           error);
  }
  if (settings.pass.is_last && settings.smoothing_px > 0) {
    launch("add_smoothing_error", add_smoothing_error, {grid(thread_rows), block}, stream,
           ImageView<const float>(refined), settings.smoothing_px, error);
  }
}

}  // namespace roadstereo::cuda

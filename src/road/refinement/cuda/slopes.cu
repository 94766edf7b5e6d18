#include "core/cuda/launch.hpp"
#include "road/refinement/cuda/slopes.hpp"

// Floor: 16 bytes a pixel. A block turns the pixels of its tile and of a border of 2·step − 1 into sums over columns in
// shared memory, and a thread adds up the rows of four boxes: with a step of 3, 40 numbers read.

namespace roadstereo::cuda {
namespace {

constexpr int tile_columns = 32, tile_rows = 8;

/// Numbers of a part of the map in shared memory: heights weighted by their precisions, and these.
struct SharedPart {
  float* numbers;
  int left, top;  ///< pixels of the map
  int columns, rows;

  __device__ float* heights(int u, int v) const { return numbers + (v - top) * columns + (u - left); }
  __device__ float* precision(int u, int v) const { return heights(u, v) + columns * rows; }

  template <class Pixel>
  __device__ void fill(const Pixel& pixel) const {
    for (int y = static_cast<int>(threadIdx.y); y < rows; y += tile_rows) {
      for (int x = static_cast<int>(threadIdx.x); x < columns; x += tile_columns) {
        const BoxMean number = pixel(left + x, top + y);
        *heights(left + x, top + y) = number.height;
        *precision(left + x, top + y) = number.precision;
      }
    }
    __syncthreads();
  }

  __device__ BoxMean box(int u, int v, int radius) const {
    float sum = 0, weights = 0;
    for (int dv = -radius; dv <= radius; ++dv) {
      sum += *heights(u, v + dv);
      weights += *precision(u, v + dv);
    }
    return box_mean(sum, weights);
  }
};

__global__ void slopes_of_tiles(MeasuredMaps maps, SlopeSettings settings, VarianceBounds bounds, SlopeMaps slopes) {
  begin_kernel();
  const int left = static_cast<int>(blockIdx.x) * tile_columns, top = static_cast<int>(blockIdx.y) * tile_rows;
  const int step = settings.step, radius = step - 1, border = step + radius;
  const int rows = tile_rows + 2 * border;
  auto* const lines = shared_memory<RowLine>();
  auto* const numbers = reinterpret_cast<float*>(lines + rows);
  const SharedPart pixels{numbers, left - border, top - border, tile_columns + 2 * border, rows};
  const SharedPart sums{numbers + 2 * pixels.columns * pixels.rows, left - step, top - border, tile_columns + 2 * step,
                        rows};
  const int thread = static_cast<int>(threadIdx.y) * tile_columns + static_cast<int>(threadIdx.x);
  for (int y = thread; y < rows; y += tile_columns * tile_rows) lines[y] = maps.road_line(pixels.top + y);
  __syncthreads();
  const auto height_at = [&](int u, int v) {
    return measured_at(maps, read_pixel(maps, u, v), lines[v - pixels.top], bounds, u, v);
  };
  pixels.fill([&](int u, int v) {
    const MeasuredHeight pixel = height_at(u, v);
    return BoxMean{pixel.precision * pixel.value, pixel.precision};
  });
  sums.fill([&](int u, int v) {
    float sum = 0, weights = 0;
    for (int du = -radius; du <= radius; ++du) {
      sum += *pixels.heights(u + du, v);
      weights += *pixels.precision(u + du, v);
    }
    return BoxMean{sum, weights};
  });
  const int u = left + static_cast<int>(threadIdx.x), v = top + static_cast<int>(threadIdx.y);
  if (u >= slopes.across.width() || v >= slopes.across.height()) return;
  const float height = height_at(u, v).value;
  const Slope across = limited_slope(height, sums.box(u - step, v, radius), sums.box(u + step, v, radius), settings);
  const Slope down = limited_slope(height, sums.box(u, v - step, radius), sums.box(u, v + step, radius), settings);
  const float share = slope_share(across, down);
  slopes.across(u, v) = share * across.value;
  slopes.down(u, v) = share * down.value;
}

}  // namespace

void find_slopes(const MeasuredMaps& maps, const SlopeSettings& settings, const VarianceBounds& bounds,
                 const SlopeMaps& slopes, StreamView stream) {
  const auto columns = [](int border) { return static_cast<std::size_t>(tile_columns + 2 * border); };
  const int border = 2 * settings.step - 1;
  const std::size_t rows = static_cast<std::size_t>(tile_rows + 2 * border);
  launch("slopes_of_tiles", slopes_of_tiles,
         {dim3(blocks_for(slopes.across.width(), tile_columns), blocks_for(slopes.across.height(), tile_rows)),
          dim3(tile_columns, tile_rows),
          rows * (sizeof(RowLine) + 2 * (columns(border) + columns(settings.step)) * sizeof(float))},
         stream, maps, settings, bounds, slopes);
}

}  // namespace roadstereo::cuda

// Floor of transform_target: 4 bytes and about 25 operations a pixel: 0.9 MB for 640×360. The four samples of a pixel
// are its neighbours' too, and come from the first cache. Floor of restore_disparity: 8 bytes and 4 operations a pixel.
// Only whole-pixel shifts of a road that rolls, which no preset has, need double precision for every pixel.

#include "core/cuda/launch.hpp"
#include "core/cuda/warp.hpp"
#include "road/cubic.hpp"
#include "road/cuda/perspective.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int row_threads = 128;

/// Rows of the target that a row of the transformed one lies between; one row where it has no offset.
struct RowSamples {
  const std::int16_t *before, *at, *after, *beyond;
  CubicWeights weights;
  bool between;
  int last;  ///< column; beyond it and before the first one the border goes on

  __device__ void prepare(const ImageView<const std::int16_t>& image, double v) {
    const double whole = floor(v);
    const auto row = [&](int below) {
      const int wanted = static_cast<int>(whole) + below;
      return image.row(wanted < 0 ? 0 : wanted >= image.height() ? image.height() - 1 : wanted);
    };
    before = row(-1);
    at = row(0);
    after = row(1);
    beyond = row(2);
    weights = cubic_weights(v - whole);
    between = v != whole;
    last = image.width() - 1;
  }

  __device__ float operator()(int u) const {
    const int x = u < 0 ? 0 : u > last ? last : u;
    if (!between) return static_cast<float>(__ldg(at + x));
    return weighted(weights, static_cast<float>(__ldg(before + x)), static_cast<float>(__ldg(at + x)),
                    static_cast<float>(__ldg(after + x)), static_cast<float>(__ldg(beyond + x)));
  }
};

/// A shift as whole pixels less a part of one.
struct PixelShift {
  int whole;
  float part;
};

/// The shift along the columns of a block, in single precision from its first column.
struct ShiftLine {
  int whole;          ///< of the shift at the first column, rounded down
  float rest, slope;  ///< what is left there, and the change with the column
  bool uneven;        ///< whole pixels, not the same in all columns

  __device__ void prepare(const PerspectiveShift& shift, int first, int v) {
    const bool linear = shift.enabled && !shift.whole_pixel;
    const double at_first = linear ? shift.road.disparity(first, v) - shift.delta_p : shift.at(first, v);
    const double down = floor(at_first);
    whole = static_cast<int>(down);
    rest = static_cast<float>(at_first - down);
    slope = linear ? static_cast<float>(shift.road.a2) : 0.0F;
    uneven = !linear && shift.at(first + row_threads - 1, v) != at_first;
  }

  __device__ PixelShift at(int column) const {
    const float by = rest + slope * static_cast<float>(column), up = ceilf(by);
    if (static_cast<float>(whole) + by <= 0) return {0, 0};
    return {whole + static_cast<int>(up), up - by};
  }
};

/// Shared memory of a block, which transforms a part of a row.
struct TransformedPart {
  int first;  ///< column that comes from inside the target
  RowSamples samples;
  ShiftLine shift;
};

/// Double precision is slow on small GPUs: three threads do what needs it, each in a warp of its own.
__global__ void transform_rows(ImageView<const std::int16_t> target, PerspectiveShift shift, float white,
                               ImageView<std::int16_t> transformed, int* first_column) {
  auto& part = *shared_memory<TransformedPart>();
  const int v = static_cast<int>(blockIdx.y), begin = static_cast<int>(blockIdx.x) * row_threads;
  const auto thread = static_cast<int>(threadIdx.x);
  if (thread == 0) {
    part.first = find_first_column(shift, v, target.width());
    if (blockIdx.x == 0) first_column[v] = part.first;
  } else if (thread == warp_lanes) {
    part.samples.prepare(target, v + shift.row_offset);
  } else if (thread == 2 * warp_lanes) {
    part.shift.prepare(shift, begin, v);
  }
  __syncthreads();
  const int x = begin + thread;
  if (x >= target.width()) return;
  if (x < part.first) {
    transformed(x, v) = 0;
    return;
  }
  const PixelShift by = part.shift.uneven ? PixelShift{static_cast<int>(shift.at(x, v)), 0} : part.shift.at(thread);
  const int source = x - by.whole;
  transformed(x, v) = grey_between(part.samples(source - 1), part.samples(source), part.samples(source + 1),
                                   part.samples(source + 2), by.part, white);
}

/// Shared memory of a block that restores a part of a row.
struct RestoredPart {
  RowLine road;       ///< less δp
  float whole_shift;  ///< of every pixel, where shifts are whole pixels and do not change along a row
};

__global__ void restore_rows(ImageView<const float> residual, PerspectiveShift shift, ImageView<float> disparity) {
  auto& part = *shared_memory<RestoredPart>();
  const int u = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int v = static_cast<int>(blockIdx.y);
  if (threadIdx.x == 0) part = {row_line(shift.road, v, shift.delta_p), static_cast<float>(shift.at(0, v))};
  __syncthreads();
  if (u >= residual.width()) return;
  const float own = residual(u, v);
  const bool even = !shift.enabled || (shift.whole_pixel && shift.road.a2 == 0);
  disparity(u, v) = even                ? own + part.whole_shift
                    : shift.whole_pixel ? with_whole_shift(own, shift, u, v)
                                        : with_shift(own, part.road, u);
}

dim3 row_blocks(int width, int height) {
  return {blocks_for(width, row_threads), static_cast<unsigned>(height)};
}

}  // namespace

void transform_target(ImageView<const std::int16_t> target, const PerspectiveShift& shift, float white,
                      ImageView<std::int16_t> transformed, int* first_column, StreamView stream) {
  launch("transform_rows", transform_rows,
         {row_blocks(target.width(), target.height()), row_threads, sizeof(TransformedPart)}, stream, target, shift,
         white, transformed, first_column);
}

void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, ImageView<float> disparity,
                       StreamView stream) {
  launch("restore_rows", restore_rows,
         {row_blocks(residual.width(), residual.height()), row_threads, sizeof(RestoredPart)}, stream, residual, shift,
         disparity);
}

}  // namespace roadstereo::cuda

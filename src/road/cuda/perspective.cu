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

/// Row v of the target as it should be: a line in the image where that is misaligned.
struct RowSamples {
  ImageView<const std::int16_t> image;
  int v;
  float offset, slope;  ///< at column 0, and its change with the column

  __device__ void prepare(const ImageView<const std::int16_t>& target, const Misalignment& misalignment, int row) {
    image = target;
    v = row;
    offset = static_cast<float>(misalignment.rows_at(0, row));
    slope = static_cast<float>(misalignment.turn_rad);
  }

  __device__ float operator()(int u) const {
    const int x = u < 0 ? 0 : u >= image.width() ? image.width() - 1 : u;
    const float by = offset + slope * static_cast<float>(x), whole = floorf(by);
    const auto at = [&](int below) {
      const int wanted = v + static_cast<int>(whole) + below, last = image.height() - 1;
      return static_cast<float>(__ldg(image.row(wanted < 0 ? 0 : wanted > last ? last : wanted) + x));
    };
    if (by == whole) return at(0);
    return weighted(cubic_weights(by - whole), at(-1), at(0), at(1), at(2));
  }
};

/// A shift as whole pixels less a part of one.
struct PixelShift {
  int whole;
  float part;

  /// The shift of a target that is misaligned by `columns`.
  __device__ PixelShift less(float columns) const {
    const float by = -part - columns, up = ceilf(by);
    return {whole + static_cast<int>(up), up - by};
  }
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
  float columns;  ///< by which the target is misaligned
};

/// Double precision is slow on small GPUs: three threads do what needs it, each in a warp of its own.
__global__ void transform_rows(ImageView<const std::int16_t> target, PerspectiveShift shift, float white,
                               ImageView<std::int16_t> transformed, int* first_column) {
  begin_kernel();
  auto& part = *shared_memory<TransformedPart>();
  const int v = static_cast<int>(blockIdx.y), begin = static_cast<int>(blockIdx.x) * row_threads;
  const auto thread = static_cast<int>(threadIdx.x);
  if (thread == 0) {
    part.first = find_first_column(shift, v, target.width());
    if (blockIdx.x == 0) first_column[v] = part.first;
  } else if (thread == warp_lanes) {
    part.samples.prepare(target, shift.misalignment, v);
    part.columns = static_cast<float>(shift.misalignment.columns_at(v));
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
  const PixelShift planned =
      part.shift.uneven ? PixelShift{static_cast<int>(shift.at(x, v)), 0} : part.shift.at(thread);
  const PixelShift by = planned.less(part.columns);
  const int source = x - by.whole;
  transformed(x, v) = grey_between(part.samples(source - 1), part.samples(source), part.samples(source + 1),
                                   part.samples(source + 2), by.part, white);
}

/// Shared memory of a block that restores a part of a row.
struct RestoredPart {
  RowLine road;       ///< less δp
  float whole_shift;  ///< of every pixel, where shifts are whole pixels and do not change along a row
};

__global__ void restore_rows(ImageView<const float> residual, PerspectiveShift shift, int pixel_step,
                             ImageView<float> disparity) {
  begin_kernel();
  auto& part = *shared_memory<RestoredPart>();
  const int x = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int y = static_cast<int>(blockIdx.y), u = x * pixel_step, v = y * pixel_step;
  if (threadIdx.x == 0) part = {row_line(shift.road, v, shift.delta_p), static_cast<float>(shift.at(0, v))};
  __syncthreads();
  if (x >= residual.width()) return;
  const float own = residual(x, y);
  const bool even = !shift.enabled || (shift.whole_pixel && shift.road.a2 == 0);
  disparity(x, y) = even                ? own + part.whole_shift
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

void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, int pixel_step,
                       ImageView<float> disparity, StreamView stream) {
  launch("restore_rows", restore_rows,
         {row_blocks(residual.width(), residual.height()), row_threads, sizeof(RestoredPart)}, stream, residual, shift,
         pixel_step, disparity);
}

}  // namespace roadstereo::cuda

// Floor: 4 bytes written a cost; with radius 3, a cost takes 14 products whose factors come from shared memory, 8
// numbers of the column sums, and about 40 operations for the correlation. 320×180 pixels of 24 disparities: 1.4
// million costs, 5.5 MB, 140 million operations. The block slides along the row, so that a column enters and leaves it
// once.

#include "core/cuda/launch.hpp"
#include "core/cuda/warp.hpp"
#include "stereo/block_correlation.hpp"
#include "stereo/coarse/coarse_column.hpp"
#include "stereo/coarse/cuda/block_costs.hpp"
#include "stereo/mid_grey.hpp"
#include "stereo/coarse/road_chance.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int warps = 4;
constexpr int columns_each = 16;  // of a warp
constexpr int segment = warps * columns_each;

/// Sums of one column over the rows of a block.
struct ColumnSums {
  int sum, square;
};

/// One view's columns around a segment, for the rows of a block: 0 where there is no pixel.
struct ViewColumns {
  short* grey;       ///< row by row
  ColumnSums* sums;  ///< per column
  int first;         ///< column of the image
  int count;

  __device__ int at(int row, int column) const { return grey[row * count + (column - first)]; }
  __device__ const ColumnSums& of(int column) const { return sums[column - first]; }
};

/// Loads a view's columns from `begin` on and sums them; pixels before `begin` do not count.
__device__ void load_columns(const ViewColumns& view, const Plane<const std::int16_t>& image, int begin,
                             int first_row, int rows) {
  const auto thread = static_cast<int>(threadIdx.x);
  for (int i = thread; i < view.count; i += warps * warp_lanes) {
    const int column = view.first + i;
    ColumnSums sums{0, 0};
    for (int r = 0; r < rows; ++r) {
      const int v = first_row + r;
      const bool inside = column >= begin && column < image.width && v >= 0 && v < image.height;
      const int grey = inside ? __ldg(&image(column, v)) - mid_grey : 0;
      view.grey[r * view.count + i] = static_cast<short>(grey);
      sums.sum += grey;
      sums.square += grey * grey;
    }
    view.sums[i] = sums;
  }
}

/// A segment of a row: both views, and what of them is seen.
struct Segment {
  ViewColumns own, other;
  int width;
  int first_other;
  int rows;  ///< of shared memory; those outside the image are 0
};

/// Adds column c of the block to the sums for disparity d, or takes it away.
template <int known_rows>
__device__ void add_column(const Segment& of, int c, int d, int sign, BlockSums& sums) {
  if (c < 0 || c >= of.width || c - d < of.first_other) return;
  const int rows = known_rows > 0 ? known_rows : of.rows;
  int product = 0;
  for (int r = 0; r < rows; ++r) product += of.own.at(r, c) * of.other.at(r, c - d);
  const ColumnSums &own = of.own.of(c), &other = of.other.of(c - d);
  sums.columns += sign;
  sums.own += sign * own.sum;
  sums.own_square += sign * own.square;
  sums.other += sign * other.sum;
  sums.other_square += sign * other.square;
  sums.product += sign * product;
}

/// First target column that the block around row v sees, found by a whole warp.
__device__ int first_seen_by_block(const CoarsePair& pair, int v, int radius) {
  if (pair.first_column == nullptr) return 0;
  const int last_row = v + radius < pair.reference.height ? v + radius : pair.reference.height - 1;
  const int begin = pair.factor * (v > radius ? v - radius : 0), end = pair.factor * (last_row + 1);
  int largest = 0;
  for (int row = begin + static_cast<int>(threadIdx.x % warp_lanes); row < end; row += warp_lanes) {
    const int column = __ldg(pair.first_column + row);
    largest = column > largest ? column : largest;
  }
  return coarse_column(warp_max(largest), pair.factor, pair.reference.width);
}

/// The costs of one disparity along the columns of a warp.
template <int known_rows>
__device__ void slide_block(const Segment& of, int radius, int image_rows, float noise_variance, int begin, int end,
                            int d, int v, const CoarseVolume& costs) {
  BlockSums sums{};
  for (int c = begin - radius; c < begin + radius; ++c) add_column<known_rows>(of, c, d, 1, sums);
  for (int u = begin; u < end; ++u) {
    add_column<known_rows>(of, u + radius, d, 1, sums);
    const bool seen = u - d >= of.first_other;
    costs.pixel(u, v)[d] = seen ? correlation_cost(sums, image_rows, noise_variance) : no_evidence;
    add_column<known_rows>(of, u - radius, d, -1, sums);
  }
}

template <int known_radius>
__global__ void block_costs_of_segments(CoarsePair pair, int any_radius, float noise_variance, CoarseVolume costs,
                                        int* first_seen) {
  const int radius = known_radius > 0 ? known_radius : any_radius, rows = 2 * radius + 1;
  const int v = costs.first_row + static_cast<int>(blockIdx.y);
  const int first = static_cast<int>(blockIdx.x) * segment;
  const int first_other = first_seen_by_block(pair, v, radius);
  if (blockIdx.x == 0 && threadIdx.x == 0) first_seen[v] = first_other;
  Segment of{{}, {}, costs.columns, first_other, rows};
  of.own = {nullptr, shared_memory<ColumnSums>(), first - radius, segment + 2 * radius};
  of.other = {nullptr, of.own.sums + of.own.count, of.own.first - (costs.disparities - 1),
              of.own.count + costs.disparities - 1};
  of.own.grey = reinterpret_cast<short*>(of.other.sums + of.other.count);
  of.other.grey = of.own.grey + rows * of.own.count;
  load_columns(of.own, pair.reference, 0, v - radius, rows);
  load_columns(of.other, pair.target, first_other, v - radius, rows);
  __syncthreads();
  const int first_row = v - radius < 0 ? 0 : v - radius;
  const int last_row = v + radius < pair.reference.height ? v + radius : pair.reference.height - 1;
  const int begin = first + static_cast<int>(threadIdx.x) / warp_lanes * columns_each;
  const int end = begin + columns_each < costs.columns ? begin + columns_each : costs.columns;
  for (int d = static_cast<int>(threadIdx.x) % warp_lanes; d < costs.disparities; d += warp_lanes) {
    slide_block<known_radius == 0 ? 0 : 2 * known_radius + 1>(of, radius, last_row - first_row + 1, noise_variance,
                                                              begin, end, d, v, costs);
  }
}

}  // namespace

void block_costs(const CoarsePair& pair, int block_radius, float noise_variance, const CoarseVolume& costs,
                 int* first_seen, cudaStream_t stream) {
  const int own = segment + 2 * block_radius, both = 2 * own + costs.disparities - 1;
  const std::size_t bytes_each = sizeof(ColumnSums) + static_cast<std::size_t>(2 * block_radius + 1) * sizeof(short);
  const LaunchShape shape{dim3(blocks_for(costs.columns, segment), static_cast<unsigned>(costs.rows)),
                          warps * warp_lanes, static_cast<std::size_t>(both) * bytes_each};
  const auto kernel = block_radius == 3 ? block_costs_of_segments<3> : block_costs_of_segments<0>;
  launch(kernel, shape, stream, pair, block_radius, noise_variance, costs, first_seen);
}

}  // namespace roadstereo::cuda

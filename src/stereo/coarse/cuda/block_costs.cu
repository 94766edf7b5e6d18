// Floor: 4 bytes written a cost; with radius 3, a cost takes 7 products whose factors come from shared memory, and
// about 20 operations for the correlation: 320×180 pixels of 24 disparities are 1.4 million costs, 5.5 MB, 60 million
// operations. The block slides along the row, so that a column enters it once; the sums over each view's whole blocks
// are made once for all disparities. The road's prior is added to a cost before it is written, as long as a warp holds
// all costs of a pixel; of more than 32 disparities, it is added to what the warp has written before.

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "core/cuda/warp.hpp"
#include "core/mid_grey.hpp"
#include "stereo/block_correlation.hpp"
#include "stereo/coarse/coarse_column.hpp"
#include "stereo/coarse/cuda/block_costs.hpp"
#include "stereo/coarse/cuda/pixel_prior.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int warps = 4;
constexpr int usual_columns = 22;  // of a warp: with the block's radius of 3 on both sides four times a block's width

/// The width of a block, where the compiler knows it; 0 is any.
template <int width>
struct Known {};

/// Sums over the rows of a block of one column, then of all columns before and with it. They may wrap around: only
/// differences are taken.
struct alignas(8) ColumnSums {
  unsigned sum, square;
};

/// One view's columns around a segment, for the rows of a block: 0 where there is no pixel that counts.
struct ViewColumns {
  BlockPart* parts;  ///< of the whole blocks around the columns
  ColumnSums* sums;  ///< of the columns up to the one before; one more than there are columns
  short* grey;       ///< row by row
  int first;         ///< column of the image
  int count;

  __device__ const short* from(int column) const { return grey + (column - first); }
  __device__ const BlockPart& part(int column) const { return parts[column - first]; }
};

/// A segment of a row as its block of threads sees it.
struct Segment {
  ViewColumns own, other;
  GradientSums* gradients;  ///< of the own columns
  PixelPrior* priors;       ///< of the segment
  CoarseRoad* road;
  int columns;               ///< of the segment
  int width, first_visible;  ///< columns of the image; the first one of the target that counts
  int radius, rows;          ///< of the block; rows of it that lie in the image
  float noise_variance;
  float inverse_whole;  ///< 1 / pixels of a whole block
};

/// Loads a view's columns from `begin` on and sums each: where the rows are known, all of a column at once.
template <int known_rows>
__device__ void load_columns(const ViewColumns& view, const ImageView<const std::int16_t>& image, int begin,
                             int first_row, int radius) {
  const int rows = known_rows > 0 ? known_rows : 2 * radius + 1;
  for (int i = static_cast<int>(threadIdx.x); i < view.count; i += warps * warp_lanes) {
    const int column = view.first + i;
    ColumnSums sums{0, 0};
    ROADSTEREO_UNROLL
    for (int r = 0; r < rows; ++r) {
      const int v = first_row + r;
      const bool inside = column >= begin && column < image.width() && v >= 0 && v < image.height();
      const int grey = inside ? __ldg(&image(column, v)) - mid_grey : 0;
      view.grey[r * view.count + i] = static_cast<short>(grey);
      sums.sum += static_cast<unsigned>(grey);
      sums.square += static_cast<unsigned>(grey * grey);
    }
    view.sums[i + 1] = sums;
  }
}

/// Adds up the columns, with a whole warp.
__device__ void accumulate_columns(const ViewColumns& view) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  ColumnSums before{0, 0};
  if (lane == 0) view.sums[0] = before;
  for (int first = 1; first <= view.count; first += warp_lanes) {
    const bool there = first + lane <= view.count;
    ColumnSums until = there ? view.sums[first + lane] : ColumnSums{0, 0};
    for (int by = 1; by < warp_lanes; by *= 2) {
      const unsigned sum = __shfl_up_sync(whole_warp, until.sum, static_cast<unsigned>(by));
      const unsigned square = __shfl_up_sync(whole_warp, until.square, static_cast<unsigned>(by));
      until.sum += lane >= by ? sum : 0;
      until.square += lane >= by ? square : 0;
    }
    until = {until.sum + before.sum, until.square + before.square};
    if (there) view.sums[first + lane] = until;
    before.sum = __shfl_sync(whole_warp, until.sum, warp_lanes - 1);
    before.square = __shfl_sync(whole_warp, until.square, warp_lanes - 1);
  }
}

/// The part of a block that the columns first … last of a view make up.
__device__ BlockPart part_of(const ViewColumns& view, int first, int last, const Segment& of) {
  const ColumnSums until = view.sums[last + 1 - view.first], before = view.sums[first - view.first];
  return block_part(static_cast<int>(until.sum - before.sum), static_cast<int>(until.square - before.square),
                    (last - first + 1) * of.rows, of.noise_variance);
}

__device__ void fill_parts(const ViewColumns& view, const Segment& of) {
  const int end = view.count - of.radius;
  for (int i = of.radius + static_cast<int>(threadIdx.x); i < end; i += warps * warp_lanes) {
    const int column = view.first + i;
    view.parts[i] = part_of(view, column - of.radius, column + of.radius, of);
  }
}

/// Σ own·other over one column of the block.
template <int known_rows>
__device__ int column_product(const Segment& of, int column, int d) {
  const int rows = known_rows > 0 ? known_rows : 2 * of.radius + 1;
  const short *own = of.own.from(column), *other = of.other.from(column - d);
  int product = 0;
  for (int r = 0; r < rows; ++r) product += own[r * of.own.count] * other[r * of.other.count];
  return product;
}

/// The cost of column u at disparity d, over the part of the block that both views see.
__device__ float cost_of(const Segment& of, int u, int d, int product) {
  if (u - d < of.first_visible) return uncorrelated_cost;
  const int left = u - of.radius, right = u + of.radius, seen = d + of.first_visible;
  const int first = left > seen ? left : seen, last = right < of.width ? right : of.width - 1;
  if (first == left && last == right) {
    return correlation_cost(of.own.part(u), of.other.part(u - d), product, of.inverse_whole);
  }
  return correlation_cost(part_of(of.own, first, last, of), part_of(of.other, first - d, last - d, of), product,
                          1.0F / static_cast<float>((last - first + 1) * of.rows));
}

/// Tells `use(u, cost)` the costs of one disparity along the columns begin … end − 1. The products of the block's
/// columns lie in registers, through which they move: unrolled, the code would be longer than what is kept near.
template <int block, class Use>
__device__ void slide_block(const Segment& of, int begin, int end, int d, Use use, Known<block>) {
  constexpr int radius = block / 2;
  int columns[block] = {}, product = 0;
  ROADSTEREO_DO_NOT_UNROLL
  for (int u = begin - 2 * radius; u < end; ++u) {
    product -= columns[0];
    ROADSTEREO_UNROLL
    for (int k = 0; k + 1 < block; ++k) columns[k] = columns[k + 1];
    columns[block - 1] = column_product<block>(of, u + radius, d);
    product += columns[block - 1];
    if (u >= begin) use(u, cost_of(of, u, d, product));
  }
}

/// The same for blocks of any size: what leaves the block is computed again.
template <class Use>
__device__ void slide_block(const Segment& of, int begin, int end, int d, Use use, Known<0>) {
  int product = 0;
  for (int c = begin - of.radius; c < begin + of.radius; ++c) product += column_product<0>(of, c, d);
  for (int u = begin; u < end; ++u) {
    product += column_product<0>(of, u + of.radius, d);
    use(u, cost_of(of, u, d, product));
    product -= column_product<0>(of, u - of.radius, d);
  }
}

/// First target column that the block around row v sees, found by a whole warp.
__device__ int first_seen_by_block(const CoarsePair& pair, int v, int radius) {
  if (pair.first_column == nullptr) return 0;
  const int last_row = v + radius < pair.reference.height() ? v + radius : pair.reference.height() - 1;
  const int begin = pair.factor * (v > radius ? v - radius : 0), end = pair.factor * (last_row + 1);
  int largest = 0;
  for (int row = begin + static_cast<int>(threadIdx.x % warp_lanes); row < end; row += warp_lanes) {
    const int column = __ldg(pair.first_column + row);
    largest = column > largest ? column : largest;
  }
  return coarse_column(warp_max(largest), pair.factor, pair.reference.width());
}

/// Shares out the memory of the block.
__device__ Segment make_segment(int first, int columns, int radius, const CoarseVolume& costs) {
  Segment of{};
  of.columns = columns;
  of.own.first = first - radius;
  of.own.count = columns + 2 * radius;
  of.other.first = of.own.first - (costs.disparities - 1);
  of.other.count = of.own.count + costs.disparities - 1;
  of.own.parts = shared_memory<BlockPart>();
  of.other.parts = of.own.parts + of.own.count;
  of.own.sums = reinterpret_cast<ColumnSums*>(of.other.parts + of.other.count);
  of.other.sums = of.own.sums + of.own.count + 1;
  of.gradients = reinterpret_cast<GradientSums*>(of.other.sums + of.other.count + 1);
  of.priors = reinterpret_cast<PixelPrior*>(of.gradients + of.own.count);
  of.road = reinterpret_cast<CoarseRoad*>(of.priors + columns);
  of.own.grey = reinterpret_cast<short*>(of.road + 1);
  of.other.grey = of.own.grey + (2 * radius + 1) * of.own.count;
  return of;
}

std::size_t shared_bytes(int columns, int radius, int disparities) {
  const auto own = static_cast<std::size_t>(columns + 2 * radius),
             both = 2 * own + static_cast<std::size_t>(disparities) - 1;
  const std::size_t of_column =
      sizeof(BlockPart) + sizeof(ColumnSums) + static_cast<std::size_t>(2 * radius + 1) * sizeof(short);
  return both * of_column + 2 * sizeof(ColumnSums) + own * sizeof(GradientSums) +
         static_cast<std::size_t>(columns) * sizeof(PixelPrior) + sizeof(CoarseRoad);
}

/// Loads what the costs of a segment need, and sums it.
template <int known_block>
__device__ void prepare(const Segment& of, const CoarsePair& pair, const RoadPrior& prior, int first, int v) {
  const int thread = static_cast<int>(threadIdx.x), first_row = v - of.radius;
  load_columns<known_block>(of.own, pair.reference, 0, first_row, of.radius);
  load_columns<known_block>(of.other, pair.target, of.first_visible, first_row, of.radius);
  for (int i = thread; i < of.own.count; i += warps * warp_lanes) {
    of.gradients[i] = column_gradients(pair.reference, of.own.first + i, v, of.radius);
  }
  if (thread == 0) *of.road = CoarseRoad(prior.shift, v, pair.factor);
  __syncthreads();
  if (thread / warp_lanes < 2) accumulate_columns(thread / warp_lanes == 0 ? of.own : of.other);
  __syncthreads();
  fill_parts(of.own, of);
  fill_parts(of.other, of);
  for (int i = thread; i < of.columns; i += warps * warp_lanes) {
    of.priors[i] = prior_of(of.gradients + i, prior, *of.road, first + i);
  }
  __syncthreads();
}

template <int known_block, int columns_each>
__global__ void block_costs_of_segments(CoarsePair pair, float noise_variance, RoadPrior prior, CoarseVolume costs,
                                        ImageView<RoadCost> roads, int* first_seen) {
  begin_kernel();
  constexpr int segment = warps * columns_each;
  // The blocks of one column of segments follow each other, so that the clipped ones, which take longest, do not all go
  // to the same multiprocessors.
  const int v = costs.first_row + static_cast<int>(blockIdx.x), first = static_cast<int>(blockIdx.y) * segment;
  const int radius = prior.block_radius, first_row = v - radius, last_row = v + radius;
  const int inside = (last_row < pair.reference.height() ? last_row : pair.reference.height() - 1) -
                     (first_row > 0 ? first_row : 0) + 1;
  Segment of = make_segment(first, segment, radius, costs);
  of.width = costs.columns;
  of.first_visible = first_seen_by_block(pair, v, radius);
  of.radius = radius;
  of.rows = inside;
  of.noise_variance = noise_variance;
  of.inverse_whole = 1.0F / static_cast<float>((2 * radius + 1) * inside);
  if (blockIdx.y == 0 && threadIdx.x == 0) first_seen[v] = of.first_visible;
  prepare<known_block>(of, pair, prior, first, v);
  const int begin = first + static_cast<int>(threadIdx.x) / warp_lanes * columns_each;
  const int end = begin + columns_each < costs.columns ? begin + columns_each : costs.columns;
  if (begin >= end) return;
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  const auto count = [&](int u) { return min(u - of.first_visible + 1, costs.disparities); };
  if (costs.pitch == warp_lanes) {
    // A lane for each disparity: what a pixel's prior needs of its costs, the warp holds.
    slide_block(
        of, begin, end, min(lane, costs.disparities - 1),
        [&](int u, float cost) {
          const RoadCost road = complete_cost(of.priors[u - first], costs, cost, count(u));
          costs.pixel(u, v)[lane] = cost;
          if (lane == 0) roads(u, v) = road;
        },
        Known<known_block>{});
    return;
  }
  for (int d = lane; d < costs.disparities; d += warp_lanes) {
    slide_block(
        of, begin, end, d, [&](int u, float cost) { costs.pixel(u, v)[d] = cost; }, Known<known_block>{});
  }
  __syncwarp();  // lanes read what others have written
  for (int u = begin; u < end; ++u) {
    const RoadCost road = complete_costs(of.priors[u - first], costs, costs.pixel(u, v), count(u));
    if (lane == 0) roads(u, v) = road;
  }
}

}  // namespace

void block_costs(const CoarsePair& pair, float noise_variance, const RoadPrior& prior, const CoarseVolume& costs,
                 ImageView<RoadCost> roads, int* first_seen, StreamView stream) {
  const auto run = [&](auto kernel, int columns_each) {
    const int segment = warps * columns_each;
    const LaunchShape shape{dim3(static_cast<unsigned>(costs.rows), blocks_for(costs.columns, segment)),
                            warps * warp_lanes, shared_bytes(segment, prior.block_radius, costs.disparities)};
    launch("block_costs", kernel, shape, stream, pair, noise_variance, prior, costs, roads, first_seen);
  };
  if (prior.block_radius == 3) {
    run(block_costs_of_segments<7, usual_columns>, usual_columns);
  } else if (prior.block_radius == 1) {  // of the search of a scene
    run(block_costs_of_segments<3, usual_columns>, usual_columns);
  } else if (shared_bytes(warps * usual_columns, prior.block_radius, costs.disparities) <= max_shared_bytes) {
    run(block_costs_of_segments<0, usual_columns>, usual_columns);
  } else {
    constexpr int fewer_columns = usual_columns / 2;  // of the largest blocks with the most disparities
    run(block_costs_of_segments<0, fewer_columns>, fewer_columns);
  }
}

}  // namespace roadstereo::cuda

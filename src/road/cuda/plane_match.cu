// Floor, a place with n = 2·range + 1 disparities: 105 pixels of the left image and 7·(15 + 2·range) of the right,
// 0.6 KB for n = 9; 105·(3·n + 3) multiplications and additions. 700 places: 0.4 MB and 4 million operations.

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "core/full_resolution.hpp"
#include "core/mid_grey.hpp"
#include "road/cuda/plane_match.hpp"
#include "road/downsampled_plane.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int places_per_block = 4;
constexpr int max_offsets = 2 * plane_match_max_range + 1;

/// Sums over a row of a block, for one of the offsets.
struct RowSums {
  float products, values, squares;
};

/// Shared memory of a warp. The rows' lengths spread what its lanes read of different rows over the banks.
struct PlaceMemory {
  float block[plane_block_height][17];
  float strip[plane_block_height][37];
  unsigned sums[16], squares[16];
  RowSums rows[plane_block_height][max_offsets];
  float correlations[max_offsets];
};

/// A search by one warp.
class PlaceSearch {
 public:
  __device__ PlaceSearch(const GuidedPair& pair, const DisparityPlane& plane, int range, int u, int v,
                         PlaceMemory& memory)
      : pair_(pair),
        plane_(plane),
        range_(range),
        offsets_(2 * range + 1),
        u_(u),
        v_(v),
        lane_(static_cast<int>(threadIdx.x) % warp_lanes),
        memory_(memory) {}

  /// Reads both images at once, then says whether the block has texture.
  __device__ bool read() {
    cut_block();
    sample_strip();
    __syncwarp();
    unsigned sum = 0, squares = 0;
    for (int x = 0; x < plane_block_width; ++x) {
      sum += memory_.sums[x];
      squares += memory_.squares[x];
    }
    constexpr double pixels = plane_block_width * plane_block_height;
    const double mean = sum / pixels;
    mean_ = static_cast<float>(mean);
    deviation_ = static_cast<float>(block_deviation(squares, mean, pixels));
    return deviation_ >= plane_match_min_deviation;
  }

  __device__ void correlate() {
    sum_rows();
    __syncwarp();
    if (lane_ < offsets_) memory_.correlations[lane_] = correlation();
    __syncwarp();
    const float* of = memory_.correlations;
    for (int i = 1; i < offsets_; ++i) best_ = of[i] > of[best_] ? i : best_;
  }

  /// The highest correlation, where it lies within a pixel of the plane; NaN when it does not, or is chance.
  __device__ float correlation_on_plane() const {
    const float highest = memory_.correlations[best_];
    const bool near = best_ >= range_ - 1 && best_ <= range_ + 1;
    return near && highest >= plane_match_min_telling_correlation ? highest : nanf("");
  }

  /// Residual to the plane of the best correlation; NaN when it is low or at an end of the range.
  __device__ float best_residual() const {
    const float* of = memory_.correlations;
    if (of[best_] < plane_match_min_correlation || best_ == 0 || best_ == offsets_ - 1) return nanf("");
    return static_cast<float>(range_ - (best_ + parabola_offset(of[best_ - 1], of[best_], of[best_ + 1])));
  }

 private:
  /// The block of the left image; a lane for each column.
  __device__ void cut_block() {
    if (lane_ >= plane_block_width) return;
    unsigned sum = 0, squares = 0;
    for (int y = 0; y < plane_block_height; ++y) {
      const int grey = __ldg(pair_.left.row(v_ + y - plane_block_half_height) + u_ - plane_block_half_width + lane_);
      memory_.block[y][lane_] = static_cast<float>(grey);
      sum += static_cast<unsigned>(grey);
      squares += static_cast<unsigned>(grey * grey);
    }
    memory_.sums[lane_] = sum;
    memory_.squares[lane_] = squares;
  }

  /// Where the strip of a row begins in the right image: a whole column, and how far behind it.
  struct RowStart {
    int column;
    float place;
  };

  __device__ RowStart row_start(int row, int first, int count) const {
    const double slope = -plane_.a2, drift = slope * (count - 1);
    const double x = first - plane_.disparity(first, row);
    const int column = static_cast<int>(floor(x + (drift < 0 ? drift : 0.0)));
    return {column, static_cast<float>(x - column)};
  }

  /// The right image along the block's rows, each column shifted by the plane; a lane for each column. Double precision
  /// is slow on small GPUs: a lane finds the start of one row for all.
  __device__ void sample_strip() {
    const int count = plane_block_width + 2 * range_, first = u_ - plane_block_half_width - range_;
    const int row_of_lane = lane_ < plane_block_height ? lane_ : plane_block_height - 1;
    const RowStart own = row_start(v_ + row_of_lane - plane_block_half_height, first, count);
    RowStart starts[plane_block_height];
    ROADSTEREO_UNROLL
    for (int y = 0; y < plane_block_height; ++y) {
      starts[y] = {__shfl_sync(whole_warp, own.column, y), __shfl_sync(whole_warp, own.place, y)};
    }
    if (lane_ >= count) return;
    const auto slope = static_cast<float>(-plane_.a2);
    float parts[plane_block_height];
    int left[plane_block_height], right[plane_block_height];
    ROADSTEREO_UNROLL
    for (int y = 0; y < plane_block_height; ++y) {
      const float place = starts[y].place + static_cast<float>(lane_) * slope, whole = floorf(place);
      const int column = starts[y].column + lane_ + static_cast<int>(whole), last = pair_.right.width() - 1;
      const std::int16_t* greys = pair_.right.row(v_ + y - plane_block_half_height);
      parts[y] = place - whole;
      left[y] = __ldg(greys + (column < last ? column : last));
      right[y] = __ldg(greys + (column + 1 < last ? column + 1 : last));
    }
    ROADSTEREO_UNROLL
    for (int y = 0; y < plane_block_height; ++y) {
      const float part = parts[y];
      memory_.strip[y][lane_] =
          (1 - part) * static_cast<float>(left[y]) + part * static_cast<float>(right[y]) - static_cast<float>(mid_grey);
    }
  }

  /// A lane for each row of each offset.
  __device__ void sum_rows() {
    for (int task = lane_; task < plane_block_height * offsets_; task += warp_lanes) {
      const int y = task / offsets_, offset = task % offsets_;
      RowSums sums{0, 0, 0};
      for (int x = 0; x < plane_block_width; ++x) {
        const float value = memory_.strip[y][offset + x];
        sums.products += (memory_.block[y][x] - mean_) * value;
        sums.values += value;
        sums.squares += value * value;
      }
      memory_.rows[y][offset] = sums;
    }
  }

  /// Of the lane's offset.
  __device__ float correlation() const {
    RowSums sums{0, 0, 0};
    for (int y = 0; y < plane_block_height; ++y) {
      const RowSums& row = memory_.rows[y][lane_];
      sums.products += row.products;
      sums.values += row.values;
      sums.squares += row.squares;
    }
    constexpr float per_pixel = 1.0F / (plane_block_width * plane_block_height);
    const float mean = sums.values * per_pixel;
    const float variance = sums.squares * per_pixel - mean * mean;
    if (!(variance >= plane_match_min_deviation * plane_match_min_deviation)) return -1;
    return sums.products * per_pixel / deviation_ / sqrtf(variance);
  }

  const GuidedPair& pair_;
  const DisparityPlane& plane_;
  int range_, offsets_, u_, v_, lane_;
  PlaceMemory& memory_;
  float mean_ = 0, deviation_ = 0;
  int best_ = 0;  ///< index of the highest correlation
};

__global__ void match_places(GuidedPair pair, SampleGrid grid, PlaneSource source, const int* needed,
                             GuidedSlots slots) {
  begin_kernel();
  const int own = static_cast<int>(threadIdx.x) / warp_lanes;
  const int place = static_cast<int>(blockIdx.x) * places_per_block + own;
  if (place >= grid.places()) return;
  const DisparityPlane plane = downsample_plane(source.get(), pair.factor);
  const int u = grid.column(place % grid.columns), v = grid.row(place / grid.columns);
  bool tried = (needed == nullptr || *needed != 0) && fabs(plane.a2) < plane_match_max_slant &&
               search_in_view(u, plane.disparity(u, v), plane_search_extent(plane.a1, plane.a2, grid.range_px),
                              pair.left.width());
  float residual = nanf(""), correlation = nanf("");
  if (tried) {
    PlaceSearch search(pair, plane, grid.range_px, u, v, shared_memory<PlaceMemory>()[own]);
    tried = search.read();
    if (tried) {
      search.correlate();
      residual = search.best_residual();
      correlation = search.correlation_on_plane();
    }
  }
  if (threadIdx.x % warp_lanes != 0) return;
  slots.u[place] = static_cast<float>(to_full_resolution(u, pair.factor));
  slots.v[place] = static_cast<float>(to_full_resolution(v, pair.factor));
  // What was matched is the target column at u − residual of the shifted image.
  const double r = residual;
  slots.d[place] = static_cast<float>((plane.disparity(u - r, v) + r) * pair.factor);
  slots.correlation[place] = correlation;
  slots.tried[place] = tried ? 1 : 0;
}

}  // namespace

void match_along_plane(const GuidedPair& pair, const SampleGrid& grid, const PlaneSource& plane, const int* needed,
                       const GuidedSlots& slots, StreamView stream) {
  if (grid.places() == 0) return;
  const LaunchShape shape{blocks_for(grid.places(), places_per_block), places_per_block * warp_lanes,
                          places_per_block * sizeof(PlaceMemory)};
  launch("match_places", match_places, shape, stream, pair, grid, plane, needed, slots);
}

}  // namespace roadstereo::cuda

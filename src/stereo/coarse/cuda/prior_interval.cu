// Floor: 12 bytes and 100 operations a coarse pixel: 0.7 MB for 320×180.

#include "core/cuda/launch.hpp"
#include "stereo/coarse/coarse_road.hpp"
#include "stereo/coarse/cuda/prior_interval.hpp"
#include "stereo/coarse/prior_interval.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int threads = 64;

/// One block a row or a part of it: the road in it takes double precision, once.
__global__ void find_intervals_of_row(ImageView<const float> prior, int factor, BorderSettings border,
                                      ImageView<float> low, ImageView<float> high) {
  begin_kernel();
  const int v = static_cast<int>(blockIdx.y), radius = border.block_radius;
  auto* road = shared_memory<CoarseRoad>();
  if (threadIdx.x == 0) *road = CoarseRoad(border.shift, v, factor);
  __syncthreads();
  const int first_row = v - radius < 0 ? 0 : v - radius;
  const int last_row = v + radius < prior.height() ? v + radius : prior.height() - 1;
  const int u = static_cast<int>(blockIdx.x) * threads + static_cast<int>(threadIdx.x);
  if (u >= prior.width()) return;
  const int first = u - radius < 0 ? 0 : u - radius;
  const int last = u + radius < prior.width() ? u + radius : prior.width() - 1;
  DisparitySpread around;
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first; column <= last; ++column) around.add(__ldg(&prior(column, row)));
  }
  const PriorInterval interval = prior_interval(prior(u, v), around, border.heights.at(road->disparity(u)), factor);
  low(u, v) = interval.low;
  high(u, v) = interval.high;
}

}  // namespace

void find_prior_intervals(ImageView<const float> prior, int factor, const BorderSettings& border, ImageView<float> low,
                          ImageView<float> high, StreamView stream) {
  launch("find_intervals_of_row", find_intervals_of_row,
         {dim3(blocks_for(prior.width(), threads), static_cast<unsigned>(prior.height())), threads, sizeof(CoarseRoad)},
         stream, prior, factor, border, low, high);
}

}  // namespace roadstereo::cuda

// Floor: that of plane_match.cu for 700 and 1500 places, and of robust_fit.hpp for as many points. What it takes is
// the latency of two searches and two fits one after the other.

#include "core/cuda/downsample.hpp"
#include "core/cuda/launch.hpp"
#include "road/cuda/road_verification.hpp"
#include "road/cuda/robust_fit.hpp"
#include "road/road_search.hpp"

namespace roadstereo::cuda {
namespace {

/// Points and tried places of a search.
__device__ void count_places(const SearchMemory& search, FitState& state, SearchStatistics& statistics) {
  int own[2] = {0, 0};
  for (int i = static_cast<int>(threadIdx.x); i < search.count; i += static_cast<int>(blockDim.x)) {
    own[0] += search.slots.d[i] == search.slots.d[i] ? 1 : 0;
    own[1] += search.slots.tried[i];
  }
  const int* sums = block_sums(own, reinterpret_cast<int*>(state.scratch));
  statistics.points = sums[0];
  statistics.tried = sums[1];
}

/// The values that the shares `low` and `high` of the floats lie below, and how many floats there are.
struct KeyRange {
  float low, high;
  int of;
};
__device__ KeyRange range_of_keys(const std::uint32_t (&keys)[fit_points_per_thread], double low, double high,
                                  RegisterSelect& select) {
  KeyRange range{};
  ROADSTEREO_DO_NOT_UNROLL
  for (int end = 0; end < 2; ++end) {
    const SelectedKey key = select.select<RegisterSelect::float_digits>(keys, ShareRank{end == 0 ? low : high});
    (end == 0 ? range.low : range.high) = value_of(key.key);
    range.of = key.of;
  }
  return range;
}

/// Inliers and the rows that they cover; a thread's own weights are visible to it.
__device__ void count_inliers(const SearchMemory& search, RegisterSelect& select, SearchStatistics& statistics) {
  std::uint32_t rows[fit_points_per_thread];
  keys_of_thread(
      search.count, [&](int i) { return search.weights[i] > 0 ? key_of(search.slots.v[i]) : RegisterSelect::no_key; },
      rows);
  const KeyRange range = range_of_keys(rows, row_p05, row_p95, select);
  statistics.inliers = range.of;
  statistics.found = range.of >= min_matches ? 1 : 0;
  if (statistics.found == 0) return;
  statistics.lowest_row = range.low;
  statistics.highest_row = range.high;
}

/// The fit to what a search found; all threads get the statistics.
__device__ SearchStatistics fit_search(const SearchMemory& search, const DisparityPlane& start, const RobustFit& fit,
                                       RegisterSelect& select) {
  FitState& state = *shared_memory<FitState>();
  SearchStatistics statistics{{start, 0, 0, 0, 0}, 0, 0, 0, 0, 0, 0};
  count_places(search, state, statistics);
  if (statistics.points < min_matches) return statistics;
  const DevicePoints points{search.slots.u, search.slots.v, search.slots.d, search.count};
  statistics.fit = BlockFit(points, fit, state, select).run(start, search.weights);
  if (statistics.fit.found != 0) count_inliers(search, select, statistics);
  return statistics;
}

__global__ void __launch_bounds__(max_fit_threads)
    fit_around(SearchMemory search, PlaneSource previous, RobustFit fit, SearchStatistics* around) {
  begin_kernel();
  RegisterSelect select(shared_memory<FitState>()->select);
  const SearchStatistics found = fit_search(search, previous.get(), fit, select);
  if (threadIdx.x == 0) *around = found;
}

/// Where the correspondences of the first search lie that are near the road.
__device__ void measure_range(const SearchMemory& around, const DisparityPlane& road, RegisterSelect& select,
                              VerificationStatistics& statistics) {
  std::uint32_t residuals[fit_points_per_thread];
  keys_of_thread(
      around.count,
      [&](int i) {
        const double expected = road.disparity(around.slots.u[i], around.slots.v[i]);
        const double value = around.slots.d[i] - expected;
        return near_road(value, expected) ? key_of(static_cast<float>(value)) : RegisterSelect::no_key;
      },
      residuals);
  const KeyRange range = range_of_keys(residuals, residual_p01, residual_p99, select);
  statistics.near = range.of;
  if (range.of < min_matches) return;
  statistics.residual_p01_px = range.low;
  statistics.residual_p99_px = range.high;
}

/// Correlation of the blocks on the road.
__device__ void measure_correlation(const SearchMemory& search, RegisterSelect& select,
                                    VerificationStatistics& statistics) {
  std::uint32_t correlations[fit_points_per_thread];
  keys_of_thread(
      search.count,
      [&](int i) {
        const float correlation = search.slots.correlation[i];
        return correlation == correlation ? key_of(correlation) : RegisterSelect::no_key;
      },
      correlations);
  const SelectedKey key = select.select<RegisterSelect::float_digits>(correlations, ShareRank{correlation_p10});
  if (key.of >= min_matches) statistics.correlation = value_of(key.key);
}

__global__ void __launch_bounds__(max_fit_threads)
    fit_close(SearchMemory search, SearchMemory around, RobustFit fit, const SearchStatistics* found_around,
              VerificationStatistics* result) {
  begin_kernel();
  VerificationStatistics own{*found_around, {}, 0, 0, 0, 0};
  RegisterSelect select(shared_memory<FitState>()->select);
  const bool needed = own.around.found != 0;
  if (needed) own.close = fit_search(search, own.around.fit.plane, fit, select);
  if (needed) measure_correlation(search, select, own);
  if (own.close.fit.found != 0) measure_range(around, own.close.fit.plane, select, own);
  if (threadIdx.x == 0) *result = own;  // not read back: it lies in the host's memory
}

LaunchShape fit_shape(int count) {
  return {1, fit_threads(count), sizeof(FitState)};
}

}  // namespace

SearchMemory RoadVerification::Search::memory(int places) {
  require_fit_points(places);
  const auto count = static_cast<std::size_t>(places > 0 ? places : 1);
  for (DeviceArray<float>* of : {&u, &v, &d, &correlation, &weights}) of->reserve(count);
  tried.reserve(count);
  return {{u.data(), v.data(), d.data(), correlation.data(), tried.data()}, places, weights.data()};
}

GuidedPair RoadVerification::downsampled(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                         StreamView stream) {
  const int factor = fine_factor(left.width());
  if (factor == 1) return {left, right, 1};
  const int width = left.width() / factor, height = left.height() / factor;
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels_.reserve(2 * size);
  const auto small_left = ImageView(pixels_.data(), width, height);
  const auto small_right = ImageView(pixels_.data() + size, width, height);
  downsample(left, right, factor, small_left, small_right, stream);
  return {small_left, small_right, factor};
}

void RoadVerification::run(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                           const PlaneSource& previous, bool with_roll, StreamView stream) {
  const GuidedPair pair = downsampled(left, right, stream);
  const auto grid = [&](const FineSearch& search) {
    return sample_grid(pair.left.width(), pair.left.height(), search.range_px, search.places);
  };
  const SampleGrid first = grid(first_search_again), second = grid(close_search_again);
  const SearchMemory around = around_.memory(first.places()), close = close_.memory(second.places());
  const RobustFit fit{fine_fit_scale * pair.factor, with_roll, fine_fit_iterations};
  SearchStatistics* found_around = found_around_.data();
  match_along_plane(pair, first, previous, nullptr, around.slots, stream);
  launch("fit_around", fit_around, fit_shape(around.count), stream, around, previous, fit, found_around);
  match_along_plane(pair, second, {&found_around->fit.plane, {}}, &found_around->found, close.slots, stream);
  launch("fit_close", fit_close, fit_shape(close.count > around.count ? close.count : around.count), stream, close,
         around, fit, found_around, result_.data());
}

}  // namespace roadstereo::cuda

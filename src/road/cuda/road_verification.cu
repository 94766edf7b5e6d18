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

/// The rows of the inliers as keys; a thread's own weights are visible to it.
__device__ void keys_of_rows(const SearchMemory& search, bool fitted, std::uint32_t (&keys)[fit_points_per_thread]) {
  keys_of_thread(
      search.count,
      [&](int i) { return fitted && search.weights[i] > 0 ? key_of(search.slots.v[i]) : RegisterSelect::no_key; },
      keys);
}

/// Inliers and the rows that they cover.
__device__ void take_rows(const SelectedKey& low, const SelectedKey& high, SearchStatistics& statistics) {
  statistics.inliers = low.of;
  statistics.found = low.of >= min_matches ? 1 : 0;
  if (statistics.found == 0) return;
  statistics.lowest_row = value_of(low.key);
  statistics.highest_row = value_of(high.key);
}

/// The fit to what a search found, without its rows; all threads get the statistics.
__device__ SearchStatistics fit_search(const SearchMemory& search, const DisparityPlane& start, const RobustFit& fit,
                                       FitState& state, RegisterSelect& select) {
  SearchStatistics statistics{{start, 0, 0, 0, 0}, 0, 0, 0, 0, 0, 0};
  count_places(search, state, statistics);
  if (statistics.points < min_matches) return statistics;
  const DevicePoints points{search.slots.u, search.slots.v, search.slots.d, search.count};
  statistics.fit = BlockFit(points, fit, state, select).run(start, search.weights);
  return statistics;
}

/// Shared memory of a kernel that selects so many ranks.
template <int ranks>
struct SearchState {
  FitState fit;
  RanksScratch<ranks> ranks_scratch;
};
using AroundState = SearchState<2>;
using CloseState = SearchState<5>;

__global__ void __launch_bounds__(max_fit_threads)
    fit_around(SearchMemory search, PlaneSource previous, RobustFit fit, SearchStatistics* around) {
  begin_kernel();
  AroundState& state = *shared_memory<AroundState>();
  RegisterSelect select(state.fit.select);
  SearchStatistics found = fit_search(search, previous.get(), fit, state.fit, select);
  std::uint32_t rows[1][fit_points_per_thread];
  keys_of_rows(search, found.fit.found != 0, rows[0]);
  const ShareRank ranks[2] = {{row_p05}, {row_p95}};
  const SelectedKey* keys = select_ranks<RegisterSelect::float_digits, 0, 0>(rows, ranks, state.ranks_scratch);
  if (threadIdx.x != 0) return;
  take_rows(keys[0], keys[1], found);
  *around = found;
}

/// Where the correspondences of the first search lie that are near the road.
__device__ void keys_of_residuals(const SearchMemory& around, bool fitted, const DisparityPlane& road,
                                  std::uint32_t (&keys)[fit_points_per_thread]) {
  keys_of_thread(
      around.count,
      [&](int i) {
        const double expected = road.disparity(around.slots.u[i], around.slots.v[i]);
        const double value = around.slots.d[i] - expected;
        return fitted && near_road(value, expected) ? key_of(static_cast<float>(value)) : RegisterSelect::no_key;
      },
      keys);
}

/// Correlation of the blocks on the road.
__device__ void keys_of_correlations(const SearchMemory& search, std::uint32_t (&keys)[fit_points_per_thread]) {
  keys_of_thread(
      search.count,
      [&](int i) {
        const float correlation = search.slots.correlation[i];
        return correlation == correlation ? key_of(correlation) : RegisterSelect::no_key;
      },
      keys);
}

/// The fit to the second search, and what both tell of the road.
__device__ void measure_close(const SearchMemory& search, const SearchMemory& around, const RobustFit& fit,
                              CloseState& state, VerificationStatistics& own) {
  RegisterSelect select(state.fit.select);
  own.close = fit_search(search, own.around.fit.plane, fit, state.fit, select);
  const bool fitted = own.close.fit.found != 0;
  std::uint32_t keys[3][fit_points_per_thread];
  keys_of_rows(search, fitted, keys[0]);
  keys_of_correlations(search, keys[1]);
  keys_of_residuals(around, fitted, own.close.fit.plane, keys[2]);
  const ShareRank ranks[5] = {{row_p05}, {row_p95}, {correlation_p10}, {residual_p01}, {residual_p99}};
  const SelectedKey* of = select_ranks<RegisterSelect::float_digits, 0, 0, 1, 2, 2>(keys, ranks, state.ranks_scratch);
  if (threadIdx.x != 0) return;
  take_rows(of[0], of[1], own.close);
  if (of[2].of >= min_matches) own.correlation = value_of(of[2].key);
  own.near = of[3].of;
  if (own.near < min_matches) return;
  own.residual_p01_px = value_of(of[3].key);
  own.residual_p99_px = value_of(of[4].key);
}

__global__ void __launch_bounds__(max_fit_threads)
    fit_close(SearchMemory search, SearchMemory around, RobustFit fit, const SearchStatistics* found_around,
              VerificationStatistics* result) {
  begin_kernel();
  VerificationStatistics own{*found_around, {}, 0, 0, 0, 0};
  if (own.around.found != 0) measure_close(search, around, fit, *shared_memory<CloseState>(), own);
  if (threadIdx.x == 0) *result = own;  // not read back: it lies in the host's memory
}

template <class State>
LaunchShape fit_shape(int count) {
  return {1, fit_threads(count), sizeof(State)};
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
  launch("fit_around", fit_around, fit_shape<AroundState>(around.count), stream, around, previous, fit, found_around);
  match_along_plane(pair, second, {&found_around->fit.plane, {}}, &found_around->found, close.slots, stream);
  launch("fit_close", fit_close, fit_shape<CloseState>(close.count > around.count ? close.count : around.count), stream,
         close, around, fit, found_around, result_.data());
}

}  // namespace roadstereo::cuda

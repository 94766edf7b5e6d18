// Floor: at most about 6000 disparities of the map, a sector of 32 bytes each: 0.2 MB; then those of block_quantile.hpp
// and robust_fit.hpp, and 40 operations a point for the moments, six of them in double precision.

#include "core/cuda/launch.hpp"
#include "core/cuda/unroll.hpp"
#include "road/bend.hpp"
#include "road/cuda/block_quantile.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/cuda/robust_fit.hpp"
#include "road/map_sample.hpp"

namespace roadstereo::cuda {
namespace {

/// The sample of a map, in global memory.
struct SampledMap {
  MapSample sample;
  int width, height;
  float *u, *v, *d, *weights;

  __device__ bool has(int i) const { return d[i] == d[i]; }
};

__device__ int thread() {
  return static_cast<int>(threadIdx.x);
}
__device__ int threads() {
  return static_cast<int>(blockDim.x);
}

/// A thread writes the places that it will work on. Maps and mask are read for several at once: memory takes long.
__device__ void take_sample(const MaskedMap& map, const SampledMap& sampled) {
  constexpr int at_once = 6;
  const int count = sampled.sample.count();
  for (int first = thread(); first < count; first += at_once * threads()) {
    int u[at_once], v[at_once];
    float d[at_once];
    bool counts[at_once];
    ROADSTEREO_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const int i = first + k * threads() < count ? first + k * threads() : first;
      u[k] = sampled.sample.at(i % sampled.sample.columns);
      v[k] = sampled.sample.at(i / sampled.sample.columns);
      d[k] = map.disparity(u[k], v[k]);  // __ldg would be put off until it is needed
      counts[k] = map.mask.data() == nullptr || __ldg(map.mask.row(v[k]) + u[k]) != 0;
    }
    ROADSTEREO_UNROLL
    for (int k = 0; k < at_once; ++k) {
      const int i = first + k * threads();
      if (i >= count) break;
      sampled.u[i] = static_cast<float>(u[k]);
      sampled.v[i] = static_cast<float>(v[k]);
      sampled.d[i] = counts[k] ? d[k] : nanf("");
    }
  }
}

/// Every point counts as one, and every missing point as none. Returns how many there are.
__device__ int count_all(const SampledMap& sampled, FitState& state) {
  int own[1] = {0};
  for (int i = thread(); i < sampled.sample.count(); i += threads()) {
    sampled.weights[i] = sampled.has(i) ? 1 : 0;
    own[0] += sampled.has(i) ? 1 : 0;
  }
  return *block_sums(own, reinterpret_cast<int*>(state.scratch));
}

/// The least-squares plane of all points; false when they lie on one line.
__device__ bool fit_least_squares(const SampledMap& sampled, FitState& state, DisparityPlane& plane) {
  const double centre_u = sampled.width / 2.0, centre_v = sampled.height / 2.0;
  double own[9] = {};
  for (int i = thread(); i < sampled.sample.count(); i += threads()) {
    if (!sampled.has(i)) continue;
    const double u = sampled.u[i] - centre_u, v = sampled.v[i] - centre_v, d = sampled.d[i];
    const double terms[9] = {1, u, v, d, u * u, u * v, v * v, u * d, v * d};
    for (int k = 0; k < 9; ++k) own[k] += terms[k];
  }
  const double* s = block_sums(own, state.scratch);
  const double n = s[0], mean_u = s[1] / n, mean_v = s[2] / n, mean_d = s[3] / n;
  const PlaneMoments moments{
      n, s[4] - mean_u * s[1], s[5] - mean_u * s[2], s[6] - mean_v * s[2], s[7] - mean_u * s[3], s[8] - mean_v * s[3]};
  if (!solve_slopes(moments, true, plane.a1, plane.a2)) return false;
  plane.a0 = mean_d - plane.a1 * (mean_v + centre_v) - plane.a2 * (mean_u + centre_u);
  return true;
}

/// Along one side of a map: the sampled places that a row or column of cells holds.
struct CellRange {
  __device__ CellRange(const MapSample& sample, int places, int cell, int size)
      : first((cell * size / cells_per_side - sample.step / 2) / sample.step - 1) {
    // cell_of() without its division.
    const auto lies_before = [&](int place, int other_cell) {
      return place < places && sample.at(place) * cells_per_side < other_cell * size;
    };
    if (first < 0) first = 0;
    while (lies_before(first, cell)) ++first;
    end = first;
    while (lies_before(end, cell + 1)) ++end;
  }
  int first, end;
};

/// What one thread solves for the block: double precision is slow on small GPUs.
struct SolvedMoments {
  FitMoments moments;
  double bend_normal;      ///< BendFit::normal
  float mean_u, mean_v;    ///< that the moments are taken about
  float level_u, level_v;  ///< LevelDirection
  float p0, pu, pv, bend;  ///< BendFit
};

/// Shared memory of measure_fit; the residuals follow.
struct MeasuringState {
  double scratch[sums_scratch(8)];
  SolvedMoments solved;
};
static_assert(sizeof(MeasuringState) + max_fit_points * sizeof(float) <= (48U << 10),
              "every device has 48 KB for a block");

/// Moments and means from the sums of the plane, about the centre of the map.
__device__ void solve_moments(const double* s, const SampledMap& sampled, const DisparityPlane& plane,
                              SolvedMoments& solved) {
  const double mean_u = s[1] / s[0], mean_v = s[2] / s[0];
  solved.moments = {
      s[0], s[4] - mean_u * s[1], s[5] - mean_u * s[2], s[6] - mean_v * s[2], s[7] - s[3] / s[0] * s[3], 0, 0, 0, 0, 0};
  solved.mean_u = static_cast<float>(mean_u + sampled.width / 2.0);
  solved.mean_v = static_cast<float>(mean_v + sampled.height / 2.0);
  const LevelDirection level(plane);
  solved.level_u = static_cast<float>(level.u);
  solved.level_v = static_cast<float>(level.v);
}

/// The bend of the residuals from its sums.
__device__ void solve_bend(const double* t, SolvedMoments& solved) {
  FitMoments& moments = solved.moments;
  const BendFit fit({moments.n, moments.uu, moments.uv, moments.vv, t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7]});
  moments.bend = fit.bend;
  solved.bend_normal = fit.normal;
  solved.p0 = static_cast<float>(fit.p0);
  solved.pu = static_cast<float>(fit.pu);
  solved.pv = static_cast<float>(fit.pv);
  solved.bend = static_cast<float>(fit.bend);
}

/// Fits the bend of the residuals.
__device__ void fit_bend(const SampledMap& sampled, const float* residuals, MeasuringState& state) {
  SolvedMoments& solved = state.solved;
  float of_thread[8] = {};
  for (int i = thread(); i < sampled.sample.count(); i += threads()) {
    const float weight = sampled.weights[i];
    if (!(weight > 0)) continue;
    const float du = sampled.u[i] - solved.mean_u, dv = sampled.v[i] - solved.mean_v;
    const float s = solved.level_u * du + solved.level_v * dv;
    const float p = weight * s * s, r = weight * residuals[i];
    const float terms[8] = {p, p * du, p * dv, p * s * s, r, r * du, r * dv, r * s * s};
    for (int k = 0; k < 8; ++k) of_thread[k] += terms[k];
  }
  double own[8];
  for (int k = 0; k < 8; ++k) own[k] = of_thread[k];
  const double* t = block_sums(own, state.scratch);
  if (thread() == 0) solve_bend(t, solved);
  __syncthreads();
}

/// Adds up the scores of a cell before they are squared; some lanes for each cell, which share its columns.
__device__ void sum_scores(const SampledMap& sampled, const float* residuals, MeasuringState& state) {
  SolvedMoments& solved = state.solved;
  double own[4] = {};
  constexpr int lanes = 8, cells = cells_per_side * cells_per_side;
  static_assert(cells % (warp_lanes / lanes) == 0, "warps stay whole");
  for (int cell = thread() / lanes; cell < cells; cell += threads() / lanes) {
    const CellRange rows(sampled.sample, sampled.sample.rows, cell / cells_per_side, sampled.height);
    const CellRange columns(sampled.sample, sampled.sample.columns, cell % cells_per_side, sampled.width);
    float along_u = 0, along_v = 0, along_bend = 0;
    for (int row = rows.first; row < rows.end; ++row) {
      for (int column = columns.first + thread() % lanes; column < columns.end; column += lanes) {
        const int i = row * sampled.sample.columns + column;
        if (!(sampled.weights[i] > 0)) continue;
        const float weight = sampled.weights[i], du = sampled.u[i] - solved.mean_u, dv = sampled.v[i] - solved.mean_v;
        const float s = solved.level_u * du + solved.level_v * dv;
        const float rest = s * s - solved.p0 - solved.pu * du - solved.pv * dv;
        along_u += weight * residuals[i] * du;
        along_v += weight * residuals[i] * dv;
        along_bend += weight * (residuals[i] - solved.bend * rest) * rest;
      }
    }
    for (int mask = lanes / 2; mask > 0; mask /= 2) {
      along_u += __shfl_xor_sync(whole_warp, along_u, mask);
      along_v += __shfl_xor_sync(whole_warp, along_v, mask);
      along_bend += __shfl_xor_sync(whole_warp, along_bend, mask);
    }
    if (thread() % lanes != 0) continue;
    own[0] += static_cast<double>(along_u) * along_u;
    own[1] += static_cast<double>(along_u) * along_v;
    own[2] += static_cast<double>(along_v) * along_v;
    own[3] += static_cast<double>(along_bend) * along_bend;
  }
  const double* sums = block_sums(own, state.scratch);
  if (thread() != 0) return;
  FitMoments& moments = solved.moments;
  moments.score_uu = sums[0];
  moments.score_uv = sums[1];
  moments.score_vv = sums[2];
  const double normal = solved.bend_normal;
  moments.bend_variance = normal > 0 ? sums[3] / (normal * normal) : 0;
}

/// Leaves the moments in shared memory, for the first thread. `residuals`, in shared memory, receives those of all
/// points. A thread adds up a few points in single precision.
__device__ void fit_moments(const SampledMap& sampled, const DisparityPlane& plane, MeasuringState& state,
                            float* residuals) {
  const double centre_u = sampled.width / 2.0, centre_v = sampled.height / 2.0;
  float of_thread[8] = {};
  for (int i = thread(); i < sampled.sample.count(); i += threads()) {
    const float weight = sampled.weights[i];
    if (!(weight > 0)) continue;
    const float u = sampled.u[i] - static_cast<float>(centre_u), v = sampled.v[i] - static_cast<float>(centre_v);
    const auto residual = static_cast<float>(sampled.d[i] - plane.disparity(sampled.u[i], sampled.v[i]));
    residuals[i] = residual;
    const float terms[8] = {1, u, v, residual, u * u, u * v, v * v, residual * residual};
    for (int k = 0; k < 8; ++k) of_thread[k] += weight * terms[k];
  }
  double own[8];
  for (int k = 0; k < 8; ++k) own[k] = of_thread[k];
  const double* s = block_sums(own, state.scratch);
  if (thread() == 0) solve_moments(s, sampled, plane, state.solved);
  __syncthreads();
  fit_bend(sampled, residuals, state);
  sum_scores(sampled, residuals, state);
}

/// `max_iterations` 0 measures the plane as it is.
__global__ void __launch_bounds__(max_fit_threads)
    fit_map(MaskedMap map, SampledMap sampled, PlaneSource source, int max_iterations, RoadFitStatistics* statistics) {
  begin_kernel();
  FitState& state = *shared_memory<FitState>();
  const DisparityPlane start = source.get();
  RoadFitStatistics own{start, {start, 0, 0, 0, 0}, 0, 1, {}};
  take_sample(map, sampled);
  if (max_iterations > 0) {
    __syncthreads();  // other threads have written a part of the sample
    const DevicePoints points{sampled.u, sampled.v, sampled.d, sampled.sample.count()};
    static_assert(sizeof state.scratch >= quantile_scratch * sizeof(std::uint64_t));
    const QuantilePlane nearest = BlockQuantile(points, start).run(reinterpret_cast<std::uint64_t*>(state.scratch));
    const RobustFit fit{start_scale_of(nearest.quantile_px), true, max_iterations};
    RegisterSelect select(state.select);
    own.fit = BlockFit(points, fit, state, select).run(nearest.plane, sampled.weights);
    own.plane = own.fit.plane;
    own.points = own.fit.points;
  }
  if (own.fit.found == 0) {
    own.points = count_all(sampled, state);
    if (max_iterations > 0) own.has_plane = fit_least_squares(sampled, state, own.plane) ? 1 : 0;
  }
  if (thread() == 0) *statistics = own;
}

/// Completes what fit_map has left: the transformation of the map does not wait for it.
__global__ void __launch_bounds__(max_fit_threads)
    measure_fit(SampledMap sampled, const RoadFitStatistics* statistics, RoadFitStatistics* result) {
  begin_kernel();
  MeasuringState& state = *shared_memory<MeasuringState>();
  RoadFitStatistics own = *statistics;
  if (own.has_plane != 0) fit_moments(sampled, own.plane, state, reinterpret_cast<float*>(&state + 1));
  if (thread() != 0) return;
  if (own.has_plane != 0) own.moments = state.solved.moments;
  *result = own;  // not read back: it lies in the host's memory
}

}  // namespace

void RoadFit::run(const MaskedMap& map, const PlaneSource& prior, int max_iterations, StreamView stream) {
  enqueue(map, prior, max_iterations, false, stream);
}

void RoadFit::measure(const MaskedMap& map, const PlaneSource& plane, StreamView stream) {
  enqueue(map, plane, 0, true, stream);
}

void RoadFit::enqueue(const MaskedMap& map, const PlaneSource& plane, int max_iterations, bool beside,
                      StreamView stream) {
  const int width = map.disparity.width(), height = map.disparity.height();
  const MapSample sample = map_sample(width, height);
  require_fit_points(sample.count());
  for (DeviceArray<float>* of : {&u_, &v_, &d_, &weights_}) {
    of->reserve(static_cast<std::size_t>(sample.count()));
  }
  const SampledMap sampled{sample, width, height, u_.data(), v_.data(), d_.data(), weights_.data()};
  const unsigned threads = fit_threads(sample.count());
  const std::size_t residual_bytes = static_cast<std::size_t>(sample.count()) * sizeof(float);
  StreamView in = beside ? branch_.fork(stream) : stream;
  launch("fit_map", fit_map, {1, threads, sizeof(FitState)}, in, map, sampled, plane, max_iterations,
         statistics_.data());
  if (!beside) in = branch_.fork(stream);
  launch("measure_fit", measure_fit, {1, threads, sizeof(MeasuringState) + residual_bytes}, in, sampled,
         statistics_.data(), result_.data());
}

}  // namespace roadstereo::cuda

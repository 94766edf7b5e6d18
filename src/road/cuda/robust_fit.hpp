#pragma once

#include <cstdint>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/register_select.hpp"
#include "core/cuda/unroll.hpp"
#include "road/cuda/robust_plane.hpp"
#include "road/robust_weights.hpp"

// IRLS plane fit with Tukey's biweight in one block of threads.

// Counted floor of an iteration, n points, which lie in registers: 45·n single-precision operations and n additions to
// counts in shared memory. One block: what counts is the way through its barriers, 6 an iteration.
//
// The normal equations are those of the residuals: what they yield is the step of the plane, so that single precision
// rounds the step and not the plane, and vanishes with it. Only the first residuals need double precision.
namespace roadstereo::cuda {

/// Points that a thread holds in registers: number thread, thread + threads ….
inline constexpr int fit_points_per_thread = 8;
/// The largest block of a fit, which leaves 72 registers to a thread.
inline constexpr int max_fit_threads = max_fit_points / fit_points_per_thread;
static_assert(max_fit_points % (fit_points_per_thread * warp_lanes) == 0);

/// What the threads of a fit share.
struct FitState {
  double scratch[sums_scratch(9)];
  RegisterSelectScratch select;
  DisparityPlane start, plane, last;  ///< of the first step, of this one, of the one before
  float step[3];                      ///< the plane's disparity minus the start's: at the origin, along v, along u
  double scale;
  double far_u, far_v;
  float origin_u, origin_v;
  float window, per_window;  ///< tukey · scale, and 1 / window
  int good, settled;
};

/// Threads of a block that fits up to `count` points.
inline unsigned fit_threads(int count) {
  constexpr int fewest = 4 * warp_lanes;  // a warp for each scheduler of a multiprocessor
  const int threads = warp_lanes * static_cast<int>(blocks_for(count, fit_points_per_thread * warp_lanes));
  return static_cast<unsigned>(threads > fewest ? threads : fewest);
}

/// The keys of the thread's items of `count`, for RegisterSelect; `key_of_item(i)` may be no_key.
template <class KeyOfItem>
__device__ void keys_of_thread(int count, KeyOfItem key_of_item, std::uint32_t (&keys)[fit_points_per_thread]) {
  ROADSTEREO_UNROLL
  for (int k = 0; k < fit_points_per_thread; ++k) {
    const int i = static_cast<int>(threadIdx.x) + k * static_cast<int>(blockDim.x);
    keys[k] = i < count ? key_of_item(i) : RegisterSelect::no_key;
  }
}

/// A fit in the block that runs, of fit_threads() or more.
class BlockFit {
 public:
  __device__ BlockFit(const DevicePoints& points, const RobustFit& fit, FitState& state, RegisterSelect& select)
      : points_(points), fit_(fit), state_(state), select_(select) {}

  /// All threads get the result. A thread writes the weights of its points, in global memory; barriers on the way make
  /// them visible to the block.
  __device__ FittedPlane run(const DisparityPlane& start, float* weights) {
    FittedPlane fitted{start, 0, 0, 0, begin(start, weights)};
    if (fitted.points < 3) return fitted;
    if (leader()) take_scale(fit_.start_scale_px);
    __syncthreads();
    while (fitted.iterations < fit_.max_iterations) {
      ++fitted.iterations;
      step(weights);
      if (state_.good == 0) return fitted;
      update_residuals();
      const float limit = state_.window;
      const SelectedKey median = select_magnitude(limit);
      if (leader()) take_median(magnitude_of(median, limit), median.of);
      __syncthreads();
      if (state_.settled != 0) break;
    }
    fitted.plane = state_.plane;
    fitted.scale_px = state_.scale;
    fitted.found = 1;
    return fitted;
  }

 private:
  static constexpr int own_points = fit_points_per_thread;

  __device__ static bool leader() { return threadIdx.x == 0; }
  __device__ static int point(int k) { return static_cast<int>(threadIdx.x) + k * static_cast<int>(blockDim.x); }

  /// First residuals, and the points that the host calls front and back. Returns how many points there are.
  __device__ int begin(const DisparityPlane& start, float* weights) {
    float d[own_points];
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      const bool there = point(k) < points_.count;
      u_[k] = there ? points_.u[point(k)] : 0;
      v_[k] = there ? points_.v[point(k)] : 0;
      d[k] = there ? points_.d[point(k)] : nanf("");
    }
    int first = points_.count, last = -1, found = 0;
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      first_[k] = residuals_[k] = static_cast<float>(static_cast<double>(d[k]) - start.disparity(u_[k], v_[k]));
      if (point(k) < points_.count) weights[point(k)] = 0;
      if (d[k] != d[k]) continue;
      first = first < point(k) ? first : point(k);
      last = point(k);
      ++found;
    }
    auto* scratch = reinterpret_cast<int*>(state_.scratch);
    first = block_best(first, Least{}, scratch);
    last = block_best(last, Greatest{}, scratch);
    const int own[1] = {found};
    found = *block_sums(own, scratch);
    if (found == 0) return 0;
    const float origin_u = points_.u[first], origin_v = points_.v[first];
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      u_[k] -= origin_u;
      v_[k] -= origin_v;
    }
    if (leader()) {
      state_.start = state_.plane = start;
      state_.origin_u = origin_u;
      state_.origin_v = origin_v;
      state_.far_u = points_.u[last];
      state_.far_v = points_.v[last];
    }
    __syncthreads();
    return found;
  }

  /// Magnitudes as keys of three digits, in steps of limit / magnitude_keys.
  static constexpr int magnitude_digits = 3;
  static constexpr std::uint32_t last_key = (1U << magnitude_digits * RegisterSelectScratch::bits) - 1;
  static constexpr auto magnitude_keys = static_cast<float>(last_key);

  /// Median of the magnitudes below `limit`.
  __device__ SelectedKey select_magnitude(float limit) {
    const float per_key = magnitude_keys / limit;
    std::uint32_t keys[own_points];
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      const float magnitude = fabsf(residuals_[k]);
      keys[k] = magnitude < limit ? static_cast<std::uint32_t>(magnitude * per_key) : RegisterSelect::no_key;
    }
    return select_.select<magnitude_digits>(keys, MiddleRank{});
  }
  /// 0 of none.
  __device__ static double magnitude_of(const SelectedKey& median, float limit) {
    constexpr double per_key = 1.0 / last_key;
    return median.of > 0 ? median.key * per_key * limit : 0;
  }

  // One thread does what needs double precision, of which small GPUs have little, and leaves it to the others.

  __device__ void take_scale(double scale) {
    state_.scale = scale;
    state_.window = static_cast<float>(tukey * scale);
    state_.per_window = 1 / state_.window;
  }

  /// The scale after a step, and whether that was the last one.
  __device__ void take_median(double median, int points) {
    const double last_scale = state_.scale, scale = narrowed_scale(median, last_scale);
    const DisparityPlane &now = state_.plane, &last = state_.last;
    const double by = now.disparity(state_.far_u, state_.far_v) - last.disparity(state_.far_u, state_.far_v);
    state_.settled = robust_fit_settled(by, now.a2 - last.a2, scale, last_scale, points) ? 1 : 0;
    take_scale(scale);
  }

  /// Weights, sums and the next plane; state_.good says whether there is one.
  __device__ void step(float* weights) {
    const float per_window = state_.per_window;
    float n = 0, su = 0, sv = 0, sr = 0, uu = 0, uv = 0, vv = 0, ur = 0, vr = 0;
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      const float tukey_of = tukey_weight(residuals_[k] * per_window);
      const float weight = tukey_of > 0 ? tukey_of : 0.0F, residual = tukey_of > 0 ? residuals_[k] : 0.0F;
      if (point(k) < points_.count) weights[point(k)] = weight;
      const float wu = weight * u_[k], wv = weight * v_[k];
      n += weight;
      su += wu;
      sv += wv;
      sr += weight * residual;
      uu += wu * u_[k];
      uv += wu * v_[k];
      vv += wv * v_[k];
      ur += wu * residual;
      vr += wv * residual;
    }
    const float own[9] = {n, su, sv, sr, uu, uv, vv, ur, vr};
    add_up_and_solve(own);
  }

  /// Adds up over the warps, in their order; the first warp solves. The barriers of the median keep the scratch from
  /// the next step's warps.
  template <int count>
  __device__ void add_up_and_solve(const float (&own)[count]) {
    const int lane = static_cast<int>(threadIdx.x) % warp_lanes, warp = static_cast<int>(threadIdx.x) / warp_lanes;
    auto* of_warps = reinterpret_cast<float*>(state_.scratch);
    int first = 0, end = count;
    const float sum = fold_lanes<warp_lanes / 2>(own, first, end);
    if (first < end) of_warps[warp * count + first] = sum;
    __syncthreads();
    if (warp == 0) {
      const int warps = static_cast<int>(blockDim.x) / warp_lanes;
      float total = 0;
      for (int w = 0; lane < count && w < warps; ++w) total += of_warps[w * count + lane];
      double sums[count];
      ROADSTEREO_UNROLL
      for (int k = 0; k < count; ++k) sums[k] = __shfl_sync(whole_warp, total, k);
      if (lane == 0) solve(sums);
    }
    __syncthreads();
  }

  /// The least-squares plane of the disparities, as a step from the last plane.
  __device__ void solve(const double (&s)[9]) {
    const double n = s[0], inverse = 1 / n;
    const double mean_u = s[1] * inverse, mean_v = s[2] * inverse, mean_r = s[3] * inverse;
    PlaneMoments m{n,
                   s[4] - mean_u * s[1],
                   s[5] - mean_u * s[2],
                   s[6] - mean_v * s[2],
                   s[7] - mean_u * s[3],
                   s[8] - mean_v * s[3]};
    DisparityPlane& plane = state_.plane;
    state_.last = plane;
    if (!fit_.with_roll) m.vd += plane.a2 * m.uv;  // what a2 explained is left to a1
    double by_a1 = 0, by_a2 = 0;
    state_.good = solve_slopes(m, fit_.with_roll, by_a1, by_a2) ? 1 : 0;
    if (state_.good == 0) return;
    if (!fit_.with_roll) by_a2 = -plane.a2;
    const double origin_u = state_.origin_u, origin_v = state_.origin_v;
    plane.a0 += mean_r - by_a1 * (mean_v + origin_v) - by_a2 * (mean_u + origin_u);
    plane.a1 += by_a1;
    plane.a2 += by_a2;
    state_.step[0] =
        static_cast<float>(plane.disparity(origin_u, origin_v) - state_.start.disparity(origin_u, origin_v));
    state_.step[1] = static_cast<float>(plane.a1 - state_.start.a1);
    state_.step[2] = static_cast<float>(plane.a2 - state_.start.a2);
  }

  __device__ void update_residuals() {
    const float at_origin = state_.step[0], along_v = state_.step[1], along_u = state_.step[2];
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      residuals_[k] = first_[k] - (at_origin + along_v * v_[k] + along_u * u_[k]);
    }
  }

  const DevicePoints& points_;
  const RobustFit& fit_;
  FitState& state_;
  RegisterSelect& select_;
  float u_[own_points], v_[own_points];  ///< relative to the origin
  float first_[own_points], residuals_[own_points];
};

}  // namespace roadstereo::cuda

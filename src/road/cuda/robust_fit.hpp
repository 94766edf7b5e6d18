#pragma once

#include <cstdint>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/block_select.hpp"
#include "core/cuda/unroll.hpp"
#include "road/cuda/robust_plane.hpp"
#include "road/robust_weights.hpp"

// IRLS plane fit with Tukey's biweight in one block of threads.

// Counted floor of an iteration, n points: 30·n single-precision operations and 5·16·n bytes of shared memory and
// first-level cache for weights, sums and residuals, then 2 passes of the median over n keys. One block: what counts is
// the way through its barriers, 10 an iteration.
//
// The normal equations are those of the residuals: what they yield is the step of the plane, so that single precision
// rounds the step and not the plane, and vanishes with it. Only the first residuals need double precision.
namespace roadstereo::cuda {

/// What the threads of a fit share.
struct FitState {
  double scratch[sums_scratch(9)];
  SelectScratch select;
  DisparityPlane start, plane;  ///< of the first step, of this one
  float step[3];                ///< the plane's disparity minus the start's: at the origin, along v, along u
  double scale;
  double far_u, far_v;
  float origin_u, origin_v;
  float per_window;  ///< 1 / window of the scale
  int good, settled;
};

/// Threads of a block that fits up to `count` points: eight for each, unless that is very few.
inline unsigned fit_threads(int count) {
  unsigned threads = 128;
  while (threads < 1024 && static_cast<int>(threads) * 8 < count) threads *= 2;
  return threads;
}

/// Shared memory of a fit.
inline std::size_t fit_shared_bytes(int count) {
  return sizeof(FitState) + static_cast<std::size_t>(count) * sizeof(float);
}

static_assert(sizeof(FitState) + max_fit_points * sizeof(float) <= (48U << 10), "every device has 48 KB for a block");

/// A fit in the block that runs.
class BlockFit {
 public:
  /// `first` and `weights` have room for all points, in global memory; `residuals` in shared memory.
  __device__ BlockFit(const DevicePoints& points, const RobustFit& fit, FitState& state, float* residuals, float* first,
                      float* weights)
      : points_(points), fit_(fit), state_(state), residuals_(residuals), first_(first), weights_(weights) {}

  /// All threads get the result; barriers on the way make the weights visible to the block.
  __device__ FittedPlane run(const DisparityPlane& start) {
    FittedPlane fitted{start, 0, 0, 0, begin(start)};
    if (fitted.points < 3) return fitted;
    const double first_scale = fit_.start_scale_px > 0 ? fit_.start_scale_px : start_scale();
    if (leader()) take_scale(first_scale);
    __syncthreads();
    while (fitted.iterations < fit_.max_iterations) {
      ++fitted.iterations;
      const DisparityPlane last = state_.plane;
      const double last_scale = state_.scale;
      step();
      if (state_.good == 0) return fitted;
      update_residuals();
      const auto window = static_cast<float>(tukey * last_scale);
      const SelectedKey median = select_magnitude(window, false);
      if (leader()) narrow(last, last_scale, magnitude_of(median, window), median.of);
      __syncthreads();
      if (state_.settled != 0) break;
    }
    fitted.plane = state_.plane;
    fitted.scale_px = state_.scale;
    fitted.found = 1;
    return fitted;
  }

 private:
  __device__ static bool leader() { return threadIdx.x == 0; }
  __device__ static int thread() { return static_cast<int>(threadIdx.x); }
  __device__ static int threads() { return static_cast<int>(blockDim.x); }

  /// First residuals, and the points that the host calls front and back. Returns how many points there are.
  __device__ int begin(const DisparityPlane& start) {
    int first = points_.count, last = -1, found = 0;
    constexpr int at_once = 4;  // points whose loads are issued together
    for (int base = thread(); base < points_.count; base += at_once * threads()) {
      float u[at_once], v[at_once], d[at_once];
      ROADSTEREO_UNROLL
      for (int k = 0; k < at_once; ++k) {
        const int i = base + k * threads() < points_.count ? base + k * threads() : base;
        u[k] = points_.u[i];
        v[k] = points_.v[i];
        d[k] = points_.d[i];
      }
      ROADSTEREO_UNROLL
      for (int k = 0; k < at_once; ++k) {
        const int i = base + k * threads();
        if (i >= points_.count) break;
        const auto residual = static_cast<float>(static_cast<double>(d[k]) - start.disparity(u[k], v[k]));
        first_[i] = residuals_[i] = residual;
        weights_[i] = 0;
        if (d[k] != d[k]) continue;
        first = first < i ? first : i;
        last = i;
        ++found;
      }
    }
    auto* scratch = reinterpret_cast<int*>(state_.scratch);
    first = block_best(first, Least{}, scratch);
    last = block_best(last, Greatest{}, scratch);
    const int own[1] = {found};
    found = *block_sums(own, scratch);
    if (found > 0 && leader()) {
      state_.start = state_.plane = start;
      state_.origin_u = points_.u[first];
      state_.origin_v = points_.v[first];
      state_.far_u = points_.u[last];
      state_.far_v = points_.v[last];
    }
    __syncthreads();
    return found;
  }

  /// The scale's clamp makes any median beyond it the same.
  __device__ double start_scale() {
    const auto limit = static_cast<float>(1.01 * max_start_scale_px / gaussian_mad);
    return start_scale_of(magnitude_of(select_magnitude(limit, true), limit));
  }

  /// Magnitudes as keys of two digits, in steps of limit / magnitude_keys: a millionth of the scale.
  static constexpr std::uint32_t last_key = (1U << 2 * DigitCounts::bits) - 1;
  static constexpr auto magnitude_keys = static_cast<float>(last_key);

  /// Median of the magnitudes below `limit`. With `all`, larger ones count as `limit`.
  __device__ SelectedKey select_magnitude(float limit, bool all) {
    const float per_key = magnitude_keys / limit;
    const auto key = [&](int i, std::uint32_t& out) {
      const float magnitude = fabsf(residuals_[i]);
      out = magnitude < limit ? static_cast<std::uint32_t>(magnitude * per_key) : last_key;
      return all ? magnitude == magnitude : magnitude < limit;
    };
    return block_select<2>(points_.count, key, MiddleRank{}, state_.select);
  }
  /// 0 of none.
  __device__ static double magnitude_of(const SelectedKey& median, float limit) {
    constexpr double per_key = 1.0 / last_key;
    return median.of > 0 ? median.key * per_key * limit : 0;
  }

  // One thread does what needs double precision, of which small GPUs have little, and leaves it to the others.

  __device__ void take_scale(double scale) {
    state_.scale = scale;
    state_.per_window = 1 / static_cast<float>(tukey * scale);
  }

  /// The scale after a step, and whether that was the last one; from the plane and the scale before it.
  __device__ void narrow(const DisparityPlane& last, double last_scale, double median, int points) {
    const double scale = narrowed_scale(median, last_scale);
    const DisparityPlane& now = state_.plane;
    const double by = now.disparity(state_.far_u, state_.far_v) - last.disparity(state_.far_u, state_.far_v);
    state_.settled = robust_fit_settled(by, now.a2 - last.a2, scale, last_scale, points) ? 1 : 0;
    take_scale(scale);
  }

  /// Weights, sums and the next plane; state_.good says whether there is one.
  __device__ void step() {
    const float per_window = state_.per_window;
    float n = 0, su = 0, sv = 0, sr = 0, uu = 0, uv = 0, vv = 0, ur = 0, vr = 0;
    for (int i = thread(); i < points_.count; i += threads()) {
      const float residual = residuals_[i];
      const float weight = tukey_weight(residual * per_window);
      weights_[i] = weight;
      if (!(weight > 0)) continue;
      const float u = points_.u[i] - state_.origin_u, v = points_.v[i] - state_.origin_v;
      const float wu = weight * u, wv = weight * v;
      n += weight;
      su += wu;
      sv += wv;
      sr += weight * residual;
      uu += wu * u;
      uv += wu * v;
      vv += wv * v;
      ur += wu * residual;
      vr += wv * residual;
    }
    const float own[9] = {n, su, sv, sr, uu, uv, vv, ur, vr};
    const float* sums = block_sums(own, reinterpret_cast<float*>(state_.scratch));
    if (leader()) solve(sums);
    __syncthreads();
  }

  /// The least-squares plane of the disparities, as a step from the last plane.
  __device__ void solve(const float* sums) {
    double s[9];
    for (int i = 0; i < 9; ++i) s[i] = sums[i];
    const double n = s[0], inverse = 1 / n;
    const double mean_u = s[1] * inverse, mean_v = s[2] * inverse, mean_r = s[3] * inverse;
    PlaneMoments m{n,
                   s[4] - mean_u * s[1],
                   s[5] - mean_u * s[2],
                   s[6] - mean_v * s[2],
                   s[7] - mean_u * s[3],
                   s[8] - mean_v * s[3]};
    DisparityPlane& plane = state_.plane;
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
    for (int i = thread(); i < points_.count; i += threads()) {
      const float u = points_.u[i] - state_.origin_u, v = points_.v[i] - state_.origin_v;
      residuals_[i] = first_[i] - (at_origin + along_v * v + along_u * u);
    }
  }

  const DevicePoints& points_;
  const RobustFit& fit_;
  FitState& state_;
  float* residuals_;
  float* first_;
  float* weights_;
};

}  // namespace roadstereo::cuda

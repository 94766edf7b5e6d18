#pragma once

#include <cstdint>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/unroll.hpp"
#include "road/cuda/robust_plane.hpp"
#include "road/least_quantile.hpp"

// least_quantile_plane() in one block of threads.

// Counted floor: 300 planes of 416 points, 10 operations each, 1.2 million, and 31 counts for the few planes that are
// better than the last one of their warp.
namespace roadstereo::cuda {

/// Values of shared memory that BlockQuantile works in.
inline constexpr int quantile_scratch = warp_lanes + 1;

/// The search in the block that runs. A warp compares a plane at a time, its lanes a part of the points each.
class BlockQuantile {
 public:
  /// Of the points, those count that can be of the road of which `start` is an estimate, if any that planes are
  /// compared by can.
  __device__ BlockQuantile(const DevicePoints& points, const DisparityPlane& start) : points_(points), start_(start) {
    load();
    if (found_ > 0) return;
    all_count_ = true;
    load();
  }

  /// All threads get the result.
  __device__ QuantilePlane run(std::uint64_t* scratch) const {
    if (found_ == 0) return {start_, 0};
    const int warp = static_cast<int>(threadIdx.x) / warp_lanes, warps = static_cast<int>(blockDim.x) / warp_lanes;
    float quantile = magnitude_of(largest_bits);
    int best = 0;
    for (int k = warp; k <= tried_planes; k += warps) {
      DisparityPlane plane = start_;
      if (k > 0 && !through_corners(k - 1, plane)) continue;
      float residuals[own_points];
      const int wanted = measure(plane, residuals);
      if (count_near(residuals, quantile) < wanted) continue;
      quantile = select(residuals, wanted);
      best = k;
    }
    const std::uint64_t key = static_cast<std::uint64_t>(bits_of(quantile)) << 32U | static_cast<unsigned>(best);
    const std::uint64_t least = block_best(key, Least{}, scratch);
    QuantilePlane result{start_, magnitude_of(static_cast<std::uint32_t>(least >> 32U))};
    const auto of_plane = static_cast<int>(least & 0xFFFFFFFFU);
    if (of_plane > 0) through_corners(of_plane - 1, result.plane);
    return result;
  }

 private:
  static_assert(compared_points % warp_lanes == 0);
  static constexpr int own_points = compared_points / warp_lanes;
  static constexpr std::uint32_t largest_bits = 0x7F7FFFFFU;  ///< of the largest float

  __device__ static int lane() { return static_cast<int>(threadIdx.x) % warp_lanes; }
  // Magnitudes and their bits have one order.
  __device__ static std::uint32_t bits_of(float magnitude) {
    return static_cast<std::uint32_t>(__float_as_int(magnitude));
  }
  __device__ static float magnitude_of(std::uint32_t bits) { return __int_as_float(static_cast<int>(bits)); }

  __device__ static int sum_of_warp(int value) {
    for (int mask = warp_lanes / 2; mask > 0; mask /= 2) value += __shfl_xor_sync(whole_warp, value, mask);
    return value;
  }

  __device__ bool counts(int i) const {
    const float d = points_.d[i];
    return all_count_ ? d == d : can_be_of_road(d, start_.disparity(points_.u[i], points_.v[i]));
  }

  __device__ void load() {
    int found = 0;
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      const int i = compared_point(lane() + k * warp_lanes, points_.count);
      const bool is_found = counts(i);
      u_[k] = points_.u[i];
      v_[k] = points_.v[i];
      d_[k] = is_found ? points_.d[i] : nanf("");
      found += is_found ? 1 : 0;
    }
    found_ = sum_of_warp(found);
  }

  __device__ bool through_corners(int k, DisparityPlane& plane) const {
    double corners[3][3];
    for (int corner = 0; corner < 3; ++corner) {
      const int i = corner_point(k, corner, points_.count);
      if (!counts(i)) return false;
      corners[corner][0] = points_.u[i];
      corners[corner][1] = points_.v[i];
      corners[corner][2] = points_.d[i];
    }
    return plane_through(corners[0], corners[1], corners[2], plane);
  }

  /// Residuals, NaN of missing points. Returns what those within the quantile count.
  __device__ int measure(const DisparityPlane& plane, float (&residuals)[own_points]) const {
    const auto a0 = static_cast<float>(plane.a0), a1 = static_cast<float>(plane.a1), a2 = static_cast<float>(plane.a2);
    int below = 0;
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) {
      residuals[k] = d_[k] - (a0 + a1 * v_[k] + a2 * u_[k]);
      below += residuals[k] < 0 ? 1 : 0;
    }
    return quantile_of(found_, sum_of_warp(below));
  }

  __device__ static int count_near(const float (&residuals)[own_points], float limit) {
    int count = 0;
    ROADSTEREO_UNROLL
    for (int k = 0; k < own_points; ++k) count += fabsf(residuals[k]) < limit ? quantile_weight(residuals[k] < 0) : 0;
    return sum_of_warp(count);
  }

  /// The quantile: the largest limit that is too low, bit by bit.
  __device__ static float select(const float (&residuals)[own_points], int wanted) {
    constexpr std::uint32_t highest_bit = 1U << 30U;
    std::uint32_t bits = 0;
    for (std::uint32_t bit = highest_bit; bit > 0; bit /= 2) {
      if (count_near(residuals, magnitude_of(bits | bit)) < wanted) bits |= bit;
    }
    return magnitude_of(bits);
  }

  const DevicePoints& points_;
  DisparityPlane start_;
  bool all_count_ = false;
  int found_ = 0;
  float u_[own_points], v_[own_points], d_[own_points];
};

}  // namespace roadstereo::cuda

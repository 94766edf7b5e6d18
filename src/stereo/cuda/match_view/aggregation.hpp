#pragma once

#include "core/cuda/unroll.hpp"
#include "stereo/cuda/match_view/block_costs.hpp"

// Bilateral aggregation, eq. (11), of the costs of one pixel at four disparities.

namespace roadstereo::cuda {

/// Largest windows of the kernels that keep the weights of the taps in registers.
inline constexpr int taps_of_default = 25, taps_of_paper = 60;

/// The window's taps as kernel parameters, which are constants. Offsets in shared memory, in bytes, become part of the
/// address of a load; as indices, the compiler would compute all addresses beforehand and keep them in local memory.
template <int max_taps>
struct TapTable {
  static constexpr int size = max_taps > 0 ? max_taps : 1;
  int cost_bytes[size];
  int pixel_bytes[size];   ///< in the staged pixels of the own view
  float log2_space[size];  ///< of padding taps −∞: their weight is 0

  __device__ const int4& costs(const int4* centre, int tap) const {
    return *reinterpret_cast<const int4*>(reinterpret_cast<const unsigned char*>(centre) + cost_bytes[tap]);
  }
  __device__ int pixel(const short* centre, int tap) const {
    return *reinterpret_cast<const short*>(reinterpret_cast<const unsigned char*>(centre) + pixel_bytes[tap]);
  }
};

/// Taps are loaded in groups of this size.
inline constexpr int taps_at_once = 5;

/// ω: eqs. (31), (32).
__device__ inline float tap_weight(float log2_space, float log2_colour, int grey_difference) {
  const auto difference = static_cast<float>(grey_difference);
  return exp2f(log2_space + log2_colour * difference * difference);
}

/// ω of a tap of the pixel (i, v), from the image.
__device__ inline float tap_weight(const ViewToMatch& view, const ViewSettings& settings, const WindowTap& tap, int i,
                                   int v, int grey) {
  const int q = min(max(i + tap.du, 0), view.own.width() - 1), row = min(max(v + tap.dv, 0), view.own.height() - 1);
  return tap_weight(tap.log2_space, settings.log2_colour, __ldg(view.own.row(row) + image_column(view, q)) - grey);
}

/// Weights of a pixel's taps: in registers where there are `max_taps` of them, else made anew for every chunk.
template <int max_taps>
struct PixelWeights {
  float of_tap[max_taps > 0 ? max_taps : 1];
  float inverse_sum;
};

/// Fills them in with what `weight_of(tap)` returns.
template <int max_taps, class WeightOf>
__device__ void weigh_taps(WeightOf weight_of, PixelWeights<max_taps>& weights) {
  float sum = 0;
  ROADSTEREO_UNROLL
  for (int t = 0; t < max_taps; ++t) {
    weights.of_tap[t] = weight_of(t);
    sum += weights.of_tap[t];
  }
  weights.inverse_sum = 1 / sum;
}

/// Σ ω c and Σ ω of four disparities.
struct Aggregate {
  float4 weighted;
  float4 weights;
};

/// Adds a tap whose costs are all there.
__device__ inline void add_whole(const int4& costs, float weight, Aggregate& sums) {
  sums.weighted.x += weight * __int_as_float(costs.x);
  sums.weighted.y += weight * __int_as_float(costs.y);
  sums.weighted.z += weight * __int_as_float(costs.z);
  sums.weighted.w += weight * __int_as_float(costs.w);
}

__device__ inline void add_known(float cost, float weight, float& weighted, float& weights) {
  if (!(cost > min_known_cost)) return;
  weighted += weight * cost;
  weights += weight;
}

__device__ inline void add_clipped(const int4& costs, float weight, Aggregate& sums) {
  add_known(__int_as_float(costs.x), weight, sums.weighted.x, sums.weights.x);
  add_known(__int_as_float(costs.y), weight, sums.weighted.y, sums.weights.y);
  add_known(__int_as_float(costs.z), weight, sums.weighted.z, sums.weights.z);
  add_known(__int_as_float(costs.w), weight, sums.weighted.w, sums.weights.w);
}

/// Σ ω c and Σ ω where a cost may be missing: the weights are those of the others.
template <int max_taps>
__device__ Aggregate aggregate_clipped(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile,
                                       const TapTable<max_taps>& taps, const PixelWeights<max_taps>& weights, int i,
                                       int v, int grey, const int4* centre) {
  Aggregate sums{make_float4(0, 0, 0, 0), make_float4(0, 0, 0, 0)};
  if (max_taps > 0) {
    ROADSTEREO_UNROLL
    for (int t = 0; t < max_taps; ++t) {
      if (t < settings.tap_count) add_clipped(taps.costs(centre, t), weights.of_tap[t], sums);
    }
  } else {
    for (int t = 0; t < settings.tap_count; ++t) {
      const WindowTap tap = settings.taps[t];
      const int4& costs = centre[tap.dv / tile.halo.step * tile.halo.cost_columns + tap.du / tile.halo.step];
      add_clipped(costs, tap_weight(view, settings, tap, i, v, grey), sums);
    }
  }
  return sums;
}

/// Energies E_d of one pixel at four disparities (eq. (11)) where no cost is missing.
template <int max_taps>
__device__ float4 whole_energies(int tap_count, const TapTable<max_taps>& taps, const PixelWeights<max_taps>& weights,
                                 const int4* centre) {
  Aggregate sums{make_float4(0, 0, 0, 0), make_float4(0, 0, 0, 0)};
  ROADSTEREO_UNROLL
  for (int first = 0; first < max_taps; first += taps_at_once) {
    if (first >= tap_count) continue;
    ROADSTEREO_UNROLL
    for (int t = first; t < first + taps_at_once; ++t) {
      if (t < max_taps) add_whole(taps.costs(centre, t), weights.of_tap[t], sums);
    }
  }
  const float scale = weights.inverse_sum;
  return make_float4(sums.weighted.x * scale, sums.weighted.y * scale, sums.weighted.z * scale,
                     sums.weighted.w * scale);
}

/// The mean of what there is; infinite where the pixel itself has no counterpart.
__device__ inline float clipped_energy(int own_cost, float weighted, float weights) {
  return __int_as_float(own_cost) > min_known_cost ? weighted / weights : INFINITY;
}

__device__ inline float4 clipped_energies(const int4& own, const Aggregate& sums) {
  return make_float4(
      clipped_energy(own.x, sums.weighted.x, sums.weights.x), clipped_energy(own.y, sums.weighted.y, sums.weights.y),
      clipped_energy(own.z, sums.weighted.z, sums.weights.z), clipped_energy(own.w, sums.weighted.w, sums.weights.w));
}

}  // namespace roadstereo::cuda

#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "roadstereo/transformed_pair.hpp"

namespace roadstereo::cuda {

/// lucas_kanade (roadstereo/lucas_kanade.hpp) on the device. Keeps its memory from frame to frame.
class LucasKanade {
 public:
  /// Enqueues the step; `radius` is at least 1. `aligned` may be `disparity`.
  void run(const TransformedPair& pair, ImageView<const float> disparity, int radius, const AlignmentSettings& settings,
           ImageView<float> aligned, StreamView stream);

 private:
  DeviceArray<AlignmentSums<float>> sums_;  ///< of each cell
  DeviceArray<float> shifts_;               ///< of each cell, residual pixels
};

}  // namespace roadstereo::cuda

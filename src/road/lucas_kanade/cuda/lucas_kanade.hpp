#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "roadstereo/transformed_pair.hpp"

namespace roadstereo::cuda {

/// lucas_kanade (roadstereo/lucas_kanade.hpp) on the device. Keeps its memory from frame to frame.
class LucasKanade {
 public:
  /// Enqueues the step; `radius` is at least 1. `aligned` may be `disparity`. Returns the correlation of every cell
  /// (road/lucas_kanade/alignment_maps.hpp), valid until the next step.
  ImageView<const float> run(const TransformedPair& pair, ImageView<const float> disparity, int radius,
                             const AlignmentSettings& settings, ImageView<float> aligned, StreamView stream);

 private:
  DeviceArray<AlignmentSums<float>> sums_;  ///< of each cell
  DeviceArray<float> shifts_;               ///< of each cell, residual pixels
  DeviceArray<float> correlation_;          ///< of each cell
};

}  // namespace roadstereo::cuda

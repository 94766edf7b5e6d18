#pragma once

#include <array>
#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "core/deblocking.hpp"

namespace roadstereo::cuda {

/// What was measured in one image.
struct DeblockedImage {
  unsigned long long between, beside;  ///< BlockSteps; 0 between two launches
  int strength;
};

/// Measures the steps between JPEG's blocks in both images of a pair, and smooths them if told to, with the same bits
/// as on the host. The host waits for nothing.
class PairDeblocking {
 public:
  void run(ImageView<std::int16_t> left, ImageView<std::int16_t> right, bool smooth, StreamView stream);

  /// Excess of the steps of the left and the right image before, BlockSteps::excess, once the stream was waited for.
  std::array<double, 2> excess() const { return {excess_.data()[0], excess_.data()[1]}; }

 private:
  DeviceArray<DeblockedImage> images_;
  DeviceArray<unsigned> arrived_;
  PinnedArray<double> excess_;
};

}  // namespace roadstereo::cuda

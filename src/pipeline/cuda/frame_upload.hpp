#pragma once

#include "core/cuda/grey.hpp"
#include "core/cuda/memory.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cuda {

/// Brings the frames of a pair into device memory: in one copy when they are on the host, in none when they are there.
class FrameUpload {
 public:
  struct Pair {
    DeviceFrame left, right;
  };

  /// The frames have one size. Throws Error for what to_grey refuses. Device memory is read where it lies, until the
  /// stream was waited for; of host memory a copy is made at once.
  Pair upload(const FrameView& left, const FrameView& right, double white_level, cudaStream_t stream);

 private:
  PinnedArray<unsigned char> on_host_;
  DeviceArray<unsigned char> on_device_;
};

}  // namespace roadstereo::cuda

#pragma once

#include "core/cuda/grey.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cuda {

/// Uploads the frames of a pair in one copy; frames in device memory are used where they are.
class FrameUpload {
 public:
  struct Pair {
    DeviceFrame left, right;
  };

  /// The frames have one size. Throws Error for what to_grey refuses. Device memory is read where it lies, until the
  /// stream was waited for; of host memory a copy is made at once.
  Pair upload(const FrameView& left, const FrameView& right, double white_level, StreamView stream);

 private:
  PinnedArray<unsigned char> on_host_;
  DeviceArray<unsigned char> on_device_;
};

}  // namespace roadstereo::cuda

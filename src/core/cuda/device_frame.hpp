#pragma once

#include "core/cuda/grey.hpp"
#include "core/grey_weights.hpp"

namespace roadstereo::cuda {

/// The frame as the kernel takes it, its bytes copied to `data` with the stride that they have in the frame. Throws
/// Error for what to_grey refuses.
inline DeviceFrame device_frame(const FrameView& frame, const void* data, double white_level) {
  return {data, frame.stride_bytes, frame.sample == SampleType::u16 ? 2 : 1, channel_count(frame.order),
          grey_weights(frame, white_level)};
}

}  // namespace roadstereo::cuda

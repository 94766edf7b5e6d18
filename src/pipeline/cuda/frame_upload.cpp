#include "pipeline/cuda/frame_upload.hpp"

#include <cstring>

#include "core/cuda/device_frame.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cuda {
namespace {

/// Throws Error for the memory of another GPU: what reads it there loses the context of the process.
bool is_on_device(const FrameView& frame) {
  cudaPointerAttributes attributes{};
  ROADSTEREO_CUDA(cudaPointerGetAttributes(&attributes, frame.data));
  if (attributes.type == cudaMemoryTypeManaged) return true;
  if (attributes.type != cudaMemoryTypeDevice) return false;
  int current = 0;
  ROADSTEREO_CUDA(cudaGetDevice(&current));
  if (attributes.device != current) {
    fail("a frame lies in the memory of GPU ", attributes.device, " and the pipeline works on GPU ", current,
         "; copy the frame there, or make the pipeline where GPU ", attributes.device, " is the current one");
  }
  return true;
}

std::size_t row_bytes(const FrameView& frame) {
  return static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(channel_count(frame.order)) *
         (frame.sample == SampleType::u16 ? 2U : 1U);
}

/// The frame with its rows one behind the other.
DeviceFrame packed_frame(const FrameView& frame, const void* data, double white_level) {
  FrameView packed = frame;
  packed.stride_bytes = static_cast<std::ptrdiff_t>(row_bytes(frame));
  return device_frame(packed, data, white_level);
}

void copy_rows(const FrameView& frame, unsigned char* to) {
  const std::size_t bytes = row_bytes(frame);
  for (int v = 0; v < frame.height; ++v) {
    const auto* from = static_cast<const unsigned char*>(frame.data) + v * frame.stride_bytes;
    std::memcpy(to + static_cast<std::size_t>(v) * bytes, from, bytes);
  }
}

}  // namespace

FrameUpload::Pair FrameUpload::upload(const FrameView& left, const FrameView& right, double white_level,
                                      StreamView stream) {
  for (const FrameView* frame : {&left, &right}) static_cast<void>(grey_weights(*frame, white_level));  // refuses
  const bool left_there = is_on_device(left), right_there = is_on_device(right);
  if (left_there != right_there)
    fail("one image lies in device memory and the other on the host; both must be together");
  if (left_there) {
    return {device_frame(left, left.data, white_level), device_frame(right, right.data, white_level)};
  }
  const auto rows = static_cast<std::size_t>(left.height);
  const std::size_t left_bytes = row_bytes(left) * rows, right_bytes = row_bytes(right) * rows;
  const std::size_t right_at = (left_bytes + 15) / 16 * 16;  // samples of 16 bits stay aligned
  on_host_.reserve(right_at + right_bytes);
  on_device_.reserve(right_at + right_bytes);
  copy_rows(left, on_host_.data());
  copy_rows(right, on_host_.data() + right_at);
  stream.upload(on_device_.data(), on_host_.data(), right_at + right_bytes);
  return {packed_frame(left, on_device_.data(), white_level),
          packed_frame(right, on_device_.data() + right_at, white_level)};
}

}  // namespace roadstereo::cuda

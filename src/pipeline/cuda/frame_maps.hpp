#pragma once

#include <cstdint>

#include "core/cuda/memory.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cuda {

/// The results of a frame in one piece of device memory, so that one copy downloads them: ℓ, σ, ℓ' and the left image.
class FrameMaps {
 public:
  void resize(int width, int height);

  ImageView<float> disparity() const { return {floats_.data(), width_, height_, width_}; }
  ImageView<float> sigma() const { return {floats_.data() + pixels_, width_, height_, width_}; }
  ImageView<float> transformed() const { return {floats_.data() + 2 * pixels_, width_, height_, width_}; }
  ImageView<std::int16_t> grey() const {
    return {reinterpret_cast<std::int16_t*>(floats_.data() + 3 * pixels_), width_, height_, width_};
  }

  /// Enqueues the copy to the host.
  void download(cudaStream_t stream);
  /// Once the stream was waited for.
  void take(FrameResult& result) const;

 private:
  int width_ = 0, height_ = 0;
  std::size_t pixels_ = 0;
  mutable DeviceArray<float> floats_;
  PinnedArray<float> on_host_;
};

}  // namespace roadstereo::cuda

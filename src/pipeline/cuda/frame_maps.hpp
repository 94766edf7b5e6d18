#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/cuda/event.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cuda {

/// The results of a frame: ℓ, σ, ℓ' and the left image, in device memory, and on the host, with the right one, in
/// pinned images that are handed out as they are.
class FrameMaps {
 public:
  /// Begins a frame, in memory that nobody holds.
  void begin(int width, int height);

  ImageView<float> disparity() const { return {memory_->disparity.data(), width_, height_, width_}; }
  ImageView<float> sigma() const { return {memory_->sigma.data(), width_, height_, width_}; }
  ImageView<float> transformed() const { return {memory_->transformed.data(), width_, height_, width_}; }
  ImageView<std::int16_t> grey() const { return {memory_->grey.data(), width_, height_, width_}; }

  /// The memory of this frame: until what is returned is released, later frames take other memory.
  std::shared_ptr<const void> hold();

  /// Enqueues the copies of all but ℓ' to the host, beside what `stream` does from now on. `right` must stay.
  void download_refined(ImageView<const std::int16_t> right, StreamView stream);
  /// Enqueues the copy of ℓ'. What waits for `stream` from now on waits for all copies.
  void download_transformed(StreamView stream);
  /// Swaps the images with those of the result, once the stream was waited for.
  void take(FrameResult& result);
  /// Waits for the copies of download_refined.
  void settle() const noexcept { StreamView(copies_.get()).settle(); }

 private:
  /// Device memory of one frame.
  struct Memory {
    DeviceArray<float> disparity, sigma, transformed;
    DeviceArray<std::int16_t> grey;
    std::atomic<int> holders{0};  ///< the last one of a frame may still be on its way out when the next begins
    bool was_held = false;        ///< since a frame began in it
  };

  int width_ = 0, height_ = 0;
  std::shared_ptr<Memory> memory_ = std::make_shared<Memory>();  ///< of this frame
  std::vector<std::shared_ptr<Memory>> all_{memory_};            ///< as many as were held at a time, and one
  std::weak_ptr<const void> holder_;                             ///< of this frame's memory
  Image<float> disparity_on_host_, sigma_on_host_, transformed_on_host_;
  GreyImage grey_on_host_, right_on_host_;
  Stream copies_;
  Event refined_{cudaEventDisableTiming}, copied_{cudaEventDisableTiming};
};

}  // namespace roadstereo::cuda

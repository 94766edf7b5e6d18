#pragma once

#include <cstdint>

#include "core/cuda/event.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cuda {

/// The results of a frame: ℓ, σ, ℓ' and the left image, in device memory, and on the host in pinned images that are
/// handed out as they are.
class FrameMaps {
 public:
  void resize(int width, int height);

  ImageView<float> disparity() const { return {disparity_.data(), width_, height_, width_}; }
  ImageView<float> sigma() const { return {sigma_.data(), width_, height_, width_}; }
  ImageView<float> transformed() const { return {transformed_.data(), width_, height_, width_}; }
  ImageView<std::int16_t> grey() const { return {grey_.data(), width_, height_, width_}; }

  /// Enqueues the copies of all but ℓ' to the host, beside what `stream` does from now on.
  void download_refined(StreamView stream);
  /// Enqueues the copy of ℓ'. What waits for `stream` from now on waits for all copies.
  void download_transformed(StreamView stream);
  /// Swaps the images with those of the result, once the stream was waited for.
  void take(FrameResult& result);
  /// Waits for the copies of download_refined.
  void settle() const noexcept { StreamView(copies_.get()).settle(); }

 private:
  int width_ = 0, height_ = 0;
  mutable DeviceArray<float> disparity_, sigma_, transformed_;
  mutable DeviceArray<std::int16_t> grey_;
  Image<float> disparity_on_host_, sigma_on_host_, transformed_on_host_;
  GreyImage grey_on_host_;
  Stream copies_;
  Event refined_{cudaEventDisableTiming}, copied_{cudaEventDisableTiming};
};

}  // namespace roadstereo::cuda

#include "pipeline/cuda/frame_maps.hpp"

#include <algorithm>
#include <utility>

namespace roadstereo::cuda {
namespace {

/// Pinned memory for images that the caller may keep longer than the pipeline.
class PinnedImageMemory final : public ImageMemory {
 public:
  void* allocate(std::size_t bytes) override { return PinnedMemory::take(bytes); }
  void deallocate(void* memory) noexcept override { PinnedMemory::give_back(memory); }
};

ImageMemory& pinned_memory() {
  static PinnedImageMemory memory;
  return memory;
}

/// Enqueues a copy to an image, which comes back from the caller as any image.
template <class T>
void copy_to_host(const ImageView<const T>& from, Image<T>& to, StreamView stream) {
  if (to.memory() != &pinned_memory()) to = Image<T>(pinned_memory());
  to.resize(from.width(), from.height());
  stream.download(to.row(0), from.data(), to.pixels() * sizeof(T));
}

}  // namespace

void FrameMaps::begin(int width, int height) {
  auto free = std::find_if(all_.begin(), all_.end(), [](const std::shared_ptr<Memory>& memory) {
    return memory->holders.load(std::memory_order_acquire) == 0;
  });
  if (free == all_.end()) free = all_.insert(all_.end(), std::make_shared<Memory>());
  memory_ = *free;
  holder_.reset();
  // What the holder has enqueued may still read, in a stream that is not known here.
  if (std::exchange(memory_->was_held, false)) ROADSTEREO_CUDA(cudaDeviceSynchronize());
  width_ = width;
  height_ = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (DeviceArray<float>* map : {&memory_->disparity, &memory_->sigma, &memory_->transformed}) map->reserve(pixels);
  memory_->grey.reserve(pixels);
}

std::shared_ptr<const void> FrameMaps::hold() {
  if (std::shared_ptr<const void> holder = holder_.lock()) return holder;
  memory_->holders.fetch_add(1, std::memory_order_relaxed);
  memory_->was_held = true;
  std::shared_ptr<const void> holder(
      memory_.get(), [memory = memory_](const void*) { memory->holders.fetch_sub(1, std::memory_order_release); });
  holder_ = holder;
  return holder;
}

void FrameMaps::download_refined(ImageView<const std::int16_t> right, StreamView stream) {
  const StreamView copies(copies_.get(), stream.recorder());
  refined_.record(stream.get());
  ROADSTEREO_CUDA(cudaStreamWaitEvent(copies.get(), refined_.get(), 0));
  copy_to_host<float>(disparity(), disparity_on_host_, copies);
  copy_to_host<float>(sigma(), sigma_on_host_, copies);
  copy_to_host<std::int16_t>(grey(), grey_on_host_, copies);
  copy_to_host(right, right_on_host_, copies);
  copied_.record(copies.get());
}

void FrameMaps::download_transformed(StreamView stream) {
  copy_to_host<float>(transformed(), transformed_on_host_, stream);
  ROADSTEREO_CUDA(cudaStreamWaitEvent(stream.get(), copied_.get(), 0));
}

void FrameMaps::take(FrameResult& result) {
  std::swap(result.disparity, disparity_on_host_);
  std::swap(result.sigma, sigma_on_host_);
  std::swap(result.transformed, transformed_on_host_);
  std::swap(result.grey, grey_on_host_);
  std::swap(result.right, right_on_host_);
}

}  // namespace roadstereo::cuda

#include "pipeline/cuda/frame_maps.hpp"

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
void copy_to_host(const ImageView<T>& from, Image<T>& to, StreamView stream) {
  if (to.memory() != &pinned_memory()) to = Image<T>(pinned_memory());
  to.resize(from.width(), from.height());
  stream.download(to.row(0), from.data(), to.pixels() * sizeof(T));
}

}  // namespace

void FrameMaps::resize(int width, int height) {
  width_ = width;
  height_ = height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (DeviceArray<float>* map : {&disparity_, &sigma_, &transformed_}) map->reserve(pixels);
  grey_.reserve(pixels);
}

void FrameMaps::download_refined(StreamView stream) {
  const StreamView copies(copies_.get(), stream.recorder());
  refined_.record(stream.get());
  ROADSTEREO_CUDA(cudaStreamWaitEvent(copies.get(), refined_.get(), 0));
  copy_to_host(disparity(), disparity_on_host_, copies);
  copy_to_host(sigma(), sigma_on_host_, copies);
  copy_to_host(grey(), grey_on_host_, copies);
  copied_.record(copies.get());
}

void FrameMaps::download_transformed(StreamView stream) {
  copy_to_host(transformed(), transformed_on_host_, stream);
  ROADSTEREO_CUDA(cudaStreamWaitEvent(stream.get(), copied_.get(), 0));
}

void FrameMaps::take(FrameResult& result) {
  std::swap(result.disparity, disparity_on_host_);
  std::swap(result.sigma, sigma_on_host_);
  std::swap(result.transformed, transformed_on_host_);
  std::swap(result.grey, grey_on_host_);
}

}  // namespace roadstereo::cuda

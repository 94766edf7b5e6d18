#pragma once

#include <cstddef>
#include <vector>

#include "core/cuda/memory.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::test {

/// A plane in device memory that owns its pixels, with a little padding behind each row.
template <class T>
class DevicePlane {
 public:
  DevicePlane(int width, int height)
      : memory_(static_cast<std::size_t>(width + padding) * static_cast<std::size_t>(height)),
        plane_{memory_.data(), width, height, width + padding} {}
  explicit DevicePlane(ImageView<const T> image) : DevicePlane(image.width(), image.height()) {
    copy(plane_.data(), plane_.stride(), image.row(0), image.stride(), cudaMemcpyHostToDevice);
  }

  ImageView<T> plane() const { return plane_; }
  ImageView<const T> view() const { return plane_; }

  Image<T> on_host() const {
    Image<T> image(plane_.width(), plane_.height());
    copy(image.row(0), image.width(), plane_.data(), plane_.stride(), cudaMemcpyDeviceToHost);
    return image;
  }

 private:
  static constexpr int padding = 3;

  void copy(T* to, std::ptrdiff_t to_stride, const T* from, std::ptrdiff_t from_stride, cudaMemcpyKind kind) const {
    const auto bytes = [](std::ptrdiff_t count) { return static_cast<std::size_t>(count) * sizeof(T); };
    ROADSTEREO_CUDA(cudaMemcpy2DAsync(to, bytes(to_stride), from, bytes(from_stride), bytes(plane_.width()),
                                      static_cast<std::size_t>(plane_.height()), kind, nullptr));
    ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  }

  cuda::DeviceArray<T> memory_;
  ImageView<T> plane_;
};

/// Numbers of the host in device memory.
template <class T>
cuda::DeviceArray<T> to_device(const std::vector<T>& numbers) {
  cuda::DeviceArray<T> copy(numbers.size());
  if (numbers.empty()) return copy;
  ROADSTEREO_CUDA(
      cudaMemcpyAsync(copy.data(), numbers.data(), numbers.size() * sizeof(T), cudaMemcpyHostToDevice, nullptr));
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  return copy;
}

template <class T>
std::vector<T> to_host(const T* numbers, std::size_t count) {
  std::vector<T> copy(count);
  ROADSTEREO_CUDA(cudaMemcpyAsync(copy.data(), numbers, count * sizeof(T), cudaMemcpyDeviceToHost, nullptr));
  ROADSTEREO_CUDA(cudaStreamSynchronize(nullptr));
  return copy;
}

}  // namespace roadstereo::test

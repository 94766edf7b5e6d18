#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <type_traits>
#include <utility>

#include "core/cuda/check.hpp"

namespace roadstereo::cuda {

/// Memory that grows and never shrinks, so that frames of one size allocate only once; growing forgets what was in it.
/// `Source` takes it and gives it back.
template <class T, class Source>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  GrowingArray() = default;
  explicit GrowingArray(std::size_t count) { reserve(count); }
  ~GrowingArray() { release(); }
  GrowingArray(const GrowingArray&) = delete;
  GrowingArray& operator=(const GrowingArray&) = delete;
  GrowingArray(GrowingArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), capacity_(std::exchange(other.capacity_, 0)) {}
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }

  /// Room for `count` elements.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    release();
    data_ = static_cast<T*>(Source::take(count * sizeof(T)));
    capacity_ = count;
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t capacity() const { return capacity_; }

 private:
  void release() {
    Source::give_back(data_);
    data_ = nullptr;
    capacity_ = 0;
  }

  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};

// What gives memory back is called by destructors, which cannot report; what broke the device was reported before.

struct DeviceMemory {
  static void* take(std::size_t bytes) {
    void* memory = nullptr;
    ROADSTEREO_CUDA(cudaMalloc(&memory, bytes));
    return memory;
  }
  static void give_back(void* memory) { static_cast<void>(cudaFree(memory)); }
};

struct PinnedMemory {
  static void* take(std::size_t bytes) {
    void* memory = nullptr;
    ROADSTEREO_CUDA(cudaHostAlloc(&memory, bytes, cudaHostAllocMapped));
    return memory;
  }
  static void give_back(void* memory) { static_cast<void>(cudaFreeHost(memory)); }
};

/// Memory of the device.
template <class T>
using DeviceArray = GrowingArray<T, DeviceMemory>;

/// Pinned host memory: copies to and from it run concurrently with kernels.
template <class T>
using PinnedArray = GrowingArray<T, PinnedMemory>;

/// Room for `count` elements in memory whose bytes are 0 when it is made: none, unless they were cleared.
template <class T>
void reserve_cleared(DeviceArray<T>& array, std::size_t count, cudaStream_t stream) {
  if (count <= array.capacity()) return;
  DeviceArray<T> fresh(count);
  ROADSTEREO_CUDA(cudaMemsetAsync(fresh.data(), 0, count * sizeof(T), stream));
  array = std::move(fresh);
}

}  // namespace roadstereo::cuda

#pragma once

#include <cuda_runtime_api.h>

#include <utility>

#include "core/cuda/check.hpp"

namespace roadstereo::cuda {

/// A point in a stream, with its time on the device's clock or without.
class Event {
 public:
  explicit Event(unsigned flags = cudaEventDefault) { ROADSTEREO_CUDA(cudaEventCreateWithFlags(&event_, flags)); }
  ~Event() {
    if (event_ != nullptr) static_cast<void>(cudaEventDestroy(event_));
  }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Event& operator=(Event&&) = delete;

  cudaEvent_t get() const { return event_; }
  void record(cudaStream_t stream) const { ROADSTEREO_CUDA(cudaEventRecord(event_, stream)); }

  /// Milliseconds since an earlier event; the device must have passed both.
  double ms_since(const Event& before) const {
    float ms = 0;
    ROADSTEREO_CUDA(cudaEventElapsedTime(&ms, before.event_, event_));
    return static_cast<double>(ms);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

}  // namespace roadstereo::cuda

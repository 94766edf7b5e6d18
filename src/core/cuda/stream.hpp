#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

#include "core/cuda/check.hpp"
#include "core/cuda/recorder.hpp"

namespace roadstereo::cuda {

/// A stream that it does not own, and what records the work that goes there, if anything does. Not thread-safe.
class StreamView {
 public:
  /// `programmatic`: Device::programmatic_launch.
  StreamView(cudaStream_t stream, Recorder* recorder = nullptr,  // NOLINT(google-explicit-constructor): a stream is one
             bool programmatic = false)
      : stream_(stream), recorder_(recorder), programmatic_(programmatic) {}

  cudaStream_t get() const { return stream_; }
  Recorder* recorder() const { return recorder_; }
  bool programmatic() const { return programmatic_; }

  /// Enqueues a copy to the device, or from it.
  void upload(void* to, const void* from, std::size_t bytes) const {
    if (recorder_ != nullptr) recorder_->count_upload(bytes);
    ROADSTEREO_CUDA(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_));
  }
  void download(void* to, const void* from, std::size_t bytes) const {
    if (recorder_ != nullptr) recorder_->count_download(bytes);
    ROADSTEREO_CUDA(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream_));
  }

  /// Waits for all that was enqueued.
  void wait() const {
    if (recorder_ != nullptr) recorder_->count_wait();
    ROADSTEREO_CUDA(cudaStreamSynchronize(stream_));
  }
  /// The same where nobody can be told of an error: before memory goes that kernels may still use.
  void settle() const noexcept { static_cast<void>(cudaStreamSynchronize(stream_)); }

 private:
  cudaStream_t stream_;
  Recorder* recorder_;
  bool programmatic_;
};

/// A stream that waits for no other.
class Stream {
 public:
  Stream() { ROADSTEREO_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }
  ~Stream() { static_cast<void>(cudaStreamDestroy(stream_)); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace roadstereo::cuda

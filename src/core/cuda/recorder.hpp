#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <vector>

#include "core/cuda/event.hpp"
#include "roadstereo/device_profile.hpp"

namespace roadstereo::cuda {

/// How many threads run a kernel, and the shared memory of each block.
struct LaunchShape {
  dim3 grid;
  dim3 block;
  std::size_t shared_bytes = 0;
};

/// Counts and times what is enqueued for a frame. Events around each launch keep kernels from overlapping.
class Recorder {
 public:
  /// Forgets the frame before.
  void begin();

  void count_upload(std::size_t bytes) { counted_.bytes_up += bytes; }
  void count_download(std::size_t bytes) { counted_.bytes_down += bytes; }
  void count_wait() { ++counted_.waits; }
  void before_launch(const char* name, const void* kernel, const LaunchShape& shape, cudaStream_t stream);
  void after_launch(cudaStream_t stream);

  /// The frame's, once the stream was waited for.
  DeviceProfile profile() const;

 private:
  struct Launch {
    const char* name = nullptr;
    const void* kernel = nullptr;
    LaunchShape shape;
    Event before, after;
  };

  DeviceProfile counted_;  ///< without kernels
  std::vector<Launch> launches_;
  std::size_t count_ = 0;  ///< of this frame
};

}  // namespace roadstereo::cuda

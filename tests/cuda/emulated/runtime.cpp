// The functions of CUDA's runtime on the host: a stream does at once what it is asked.

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>

#include "cuda_runtime.h"
#include "run_kernel.hpp"

struct CUstream_st {
  std::atomic<bool> has_copies{false};
};
struct CUevent_st {
  std::chrono::steady_clock::time_point time{};
  bool recorded = false;
};

namespace {

/// Which memory is whose: pointers are of the device, of pinned memory, or unknown.
class Memory {
 public:
  cudaError_t take(void** memory, std::size_t bytes, cudaPointerAttributes whose) {
    constexpr std::size_t most = std::size_t{1} << 34;
    *memory = bytes <= most ? std::malloc(bytes) : nullptr;
    if (*memory == nullptr) return cudaErrorMemoryAllocation;
    std::memset(*memory, 0xFF, bytes);
    const std::lock_guard lock(mutex_);
    ++count_;
    blocks_[*memory] = {bytes, whose};
    return cudaSuccess;
  }

  cudaError_t give_back(void* memory) {
    if (memory == nullptr) return cudaSuccess;
    {
      const std::lock_guard lock(mutex_);
      if (blocks_.erase(memory) == 0) return cudaErrorInvalidValue;
    }
    std::free(memory);
    return cudaSuccess;
  }

  cudaPointerAttributes attributes_of(const void* pointer) {
    const std::lock_guard lock(mutex_);
    const cudaPointerAttributes unknown{cudaMemoryTypeUnregistered, 0};
    auto block = blocks_.upper_bound(pointer);
    if (block == blocks_.begin()) return unknown;
    --block;
    const auto distance = static_cast<const char*>(pointer) - static_cast<const char*>(block->first);
    return static_cast<std::size_t>(distance) < block->second.bytes ? block->second.whose : unknown;
  }

  std::size_t count() {
    const std::lock_guard lock(mutex_);
    return count_;
  }

 private:
  struct Block {
    std::size_t bytes;
    cudaPointerAttributes whose;
  };
  std::mutex mutex_;
  std::map<const void*, Block> blocks_;
  std::size_t count_ = 0;
};

constexpr int devices = 2;  // so that one can be the wrong one
thread_local int current_device = 0;
std::atomic<int> with_copies{0};

void set_copies(cudaStream_t stream, bool copies) {
  if (stream == nullptr || stream->has_copies.exchange(copies) == copies) return;
  with_copies += copies ? 1 : -1;
}

/// One for the process, as a device's memory is.
Memory& memory() {
  static Memory all;
  return all;
}

}  // namespace

std::size_t roadstereo::cuda::emulated::allocations() {
  return memory().count();
}

int roadstereo::cuda::emulated::streams_with_copies() {
  return with_copies;
}

cudaError_t cudaGetDeviceCount(int* count) {
  *count = devices;
  return cudaSuccess;
}
cudaError_t cudaGetDevice(int* device) {
  *device = current_device;
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int device) {
  if (device < 0 || device >= devices) return cudaErrorInvalidValue;
  current_device = device;
  return cudaSuccess;
}
cudaError_t cudaDeviceSynchronize() {
  return cudaSuccess;
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int) {
  *properties = {};
  std::strncpy(properties->name, "the host's imitation of a GPU", sizeof properties->name - 1);
  properties->multiProcessorCount = 2;
  return cudaSuccess;
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int) {
  *value = attribute == cudaDevAttrMaxThreadsPerMultiProcessor ? 1024 : 2;
  return cudaSuccess;
}
cudaError_t cudaDriverGetVersion(int* version) {
  *version = 0;
  return cudaSuccess;
}
cudaError_t cudaRuntimeGetVersion(int* version) {
  *version = 0;
  return cudaSuccess;
}
cudaError_t cudaGetLastError() {
  return cudaSuccess;
}
const char* cudaGetErrorString(cudaError_t error) {
  return error == cudaErrorMemoryAllocation ? "out of memory" : error == cudaSuccess ? "no error" : "invalid argument";
}
const char* cudaGetErrorName(cudaError_t error) {
  return error == cudaErrorMemoryAllocation ? "cudaErrorMemoryAllocation"
         : error == cudaSuccess             ? "cudaSuccess"
                                            : "cudaErrorInvalidValue";
}
cudaError_t cudaMalloc(void** pointer, std::size_t bytes) {
  return memory().take(pointer, bytes, {cudaMemoryTypeDevice, current_device});
}
cudaError_t cudaFree(void* pointer) {
  return memory().give_back(pointer);
}
cudaError_t cudaHostAlloc(void** pointer, std::size_t bytes, unsigned) {
  return memory().take(pointer, bytes, {cudaMemoryTypeHost, current_device});
}
cudaError_t cudaFreeHost(void* pointer) {
  return memory().give_back(pointer);
}
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* pointer) {
  *attributes = memory().attributes_of(pointer);
  return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t stream) {
  std::memcpy(to, from, bytes);
  set_copies(stream, true);
  return cudaSuccess;
}
cudaError_t cudaMemcpy2DAsync(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                              std::size_t bytes, std::size_t rows, cudaMemcpyKind, cudaStream_t) {
  for (std::size_t row = 0; row < rows; ++row) {
    std::memcpy(static_cast<char*>(to) + row * to_pitch, static_cast<const char*>(from) + row * from_pitch, bytes);
  }
  return cudaSuccess;
}
cudaError_t cudaMemsetAsync(void* pointer, int byte, std::size_t bytes, cudaStream_t) {
  std::memset(pointer, byte, bytes);
  return cudaSuccess;
}
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  *stream = new CUstream_st;
  return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  set_copies(stream, false);
  delete stream;
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  set_copies(stream, false);
  return cudaSuccess;
}
cudaError_t cudaStreamWaitEvent(cudaStream_t, cudaEvent_t, unsigned) {
  return cudaSuccess;
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
  *event = new CUevent_st;
  return cudaSuccess;
}
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  delete event;
  return cudaSuccess;
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t) {
  event->time = std::chrono::steady_clock::now();
  event->recorded = true;
  return cudaSuccess;
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t first, cudaEvent_t last) {
  if (!first->recorded || !last->recorded) return cudaErrorInvalidValue;
  *ms = std::chrono::duration<float, std::milli>(last->time - first->time).count();
  return cudaSuccess;
}

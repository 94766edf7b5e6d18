#pragma once

// The part of CUDA that the project uses, on the host: types, qualifiers and what kernels call. The functions of the
// runtime are in runtime.cpp, threads and barriers in run_kernel.cpp. Names are CUDA's.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "threads.hpp"
#include "types.h"

#define CUDART_VERSION 13000
#define __global__
#define __device__
#define __host__
#define __forceinline__ inline
#define __restrict__ __restrict
#define __launch_bounds__(...)
#define __align__(n) alignas(n)

#define threadIdx (::roadstereo::cuda::emulated::here().thread)
#define blockIdx (::roadstereo::cuda::emulated::here().block)
#define blockDim (::roadstereo::cuda::emulated::here().block_size)
#define gridDim (::roadstereo::cuda::emulated::here().grid_size)

inline void __syncthreads() {
  ::roadstereo::cuda::emulated::wait_for_block();
}
inline void __syncwarp(unsigned = 0xFFFFFFFFU) {
  ::roadstereo::cuda::emulated::wait_for_warp();
}
inline void __threadfence() {}  // blocks run one after the other
template <class T>
T __shfl_sync(unsigned, T value, int from) {
  return ::roadstereo::cuda::emulated::exchange_value(value, from & 31);
}
template <class T>
T __shfl_xor_sync(unsigned, T value, int mask) {
  return ::roadstereo::cuda::emulated::exchange_value(value, ::roadstereo::cuda::emulated::lane() ^ mask);
}
template <class T>
T __shfl_down_sync(unsigned, T value, unsigned by) {
  const int own = ::roadstereo::cuda::emulated::lane(), from = own + static_cast<int>(by);
  return ::roadstereo::cuda::emulated::exchange_value(value, from < 32 ? from : own);
}
template <class T>
T __shfl_up_sync(unsigned, T value, unsigned by) {
  const int own = ::roadstereo::cuda::emulated::lane(), from = own - static_cast<int>(by);
  return ::roadstereo::cuda::emulated::exchange_value(value, from >= 0 ? from : own);
}
inline int __reduce_min_sync(unsigned, int value) {
  return ::roadstereo::cuda::emulated::smallest(value);
}
inline int __reduce_max_sync(unsigned, int value) {
  return -1 - ::roadstereo::cuda::emulated::smallest(-1 - value);
}
inline unsigned __ballot_sync(unsigned, bool vote) {
  return ::roadstereo::cuda::emulated::ballot(vote);
}
inline int __any_sync(unsigned mask, bool vote) {
  return __ballot_sync(mask, vote) != 0;
}
template <class T>
T min(T a, T b) {
  return b < a ? b : a;
}
template <class T>
T max(T a, T b) {
  return a < b ? b : a;
}
template <class T>
T __ldg(const T* at) {
  return *at;
}
inline int __popc(unsigned bits) {
  return __builtin_popcount(bits);
}
inline int __ffs(int bits) {
  return __builtin_ffs(bits);
}
inline int __float2int_rn(float value) {
  return static_cast<int>(std::lrint(value));
}
inline int __float_as_int(float value) {
  int bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
inline float __int_as_float(int bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Puts `change(what was there)` at its place, whatever other threads do at the same time.
template <class T, class Change>
T change_at_once(T* at, Change change) {
  T before = __atomic_load_n(at, __ATOMIC_RELAXED);
  while (!__atomic_compare_exchange_n(at, &before, change(before), false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return before;
}
template <class T>
T atomicAdd(T* at, T value) {
  return __atomic_fetch_add(at, value, __ATOMIC_RELAXED);
}
template <class T>
T atomicMin(T* at, T value) {
  return change_at_once(at, [value](T before) { return value < before ? value : before; });
}
template <class T>
T atomicMax(T* at, T value) {
  return change_at_once(at, [value](T before) { return before < value ? value : before; });
}
template <class T>
T atomicOr(T* at, T value) {
  return __atomic_fetch_or(at, value, __ATOMIC_RELAXED);
}

enum cudaError_t { cudaSuccess = 0, cudaErrorInvalidValue = 1, cudaErrorMemoryAllocation = 2 };
enum cudaMemcpyKind {
  cudaMemcpyHostToHost,
  cudaMemcpyHostToDevice,
  cudaMemcpyDeviceToHost,
  cudaMemcpyDeviceToDevice,
  cudaMemcpyDefault
};
enum cudaMemoryType { cudaMemoryTypeUnregistered, cudaMemoryTypeHost, cudaMemoryTypeDevice, cudaMemoryTypeManaged };
enum cudaDeviceAttr { cudaDevAttrMaxThreadsPerMultiProcessor, cudaDevAttrMultiProcessorCount };
struct cudaPointerAttributes {
  cudaMemoryType type;
  int device;
};
struct cudaDeviceProp {
  char name[256];
  int major, minor, multiProcessorCount;
};
struct cudaFuncAttributes {
  int numRegs, ptxVersion;
  std::size_t localSizeBytes, sharedSizeBytes;
};
using cudaStream_t = struct CUstream_st*;
using cudaEvent_t = struct CUevent_st*;
constexpr unsigned cudaStreamNonBlocking = 1;
constexpr unsigned cudaHostAllocMapped = 2;
constexpr unsigned cudaEventDefault = 0;
constexpr unsigned cudaEventDisableTiming = 2;

/// Every kernel is there.
template <class Kernel>
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, Kernel*) {
  *attributes = {};
  return cudaSuccess;
}
/// One block at a time.
inline cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void*, int, std::size_t) {
  *blocks = 1;
  return cudaSuccess;
}
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaGetDevice(int* device);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaDeviceSynchronize();
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device);
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device);
cudaError_t cudaDriverGetVersion(int* version);
cudaError_t cudaRuntimeGetVersion(int* version);
cudaError_t cudaGetLastError();
const char* cudaGetErrorString(cudaError_t error);
const char* cudaGetErrorName(cudaError_t error);
cudaError_t cudaMalloc(void** memory, std::size_t bytes);
cudaError_t cudaFree(void* memory);
cudaError_t cudaHostAlloc(void** memory, std::size_t bytes, unsigned flags);
cudaError_t cudaFreeHost(void* memory);
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* pointer);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream);
cudaError_t cudaMemcpy2DAsync(void* to, std::size_t to_pitch, const void* from, std::size_t from_pitch,
                              std::size_t bytes, std::size_t rows, cudaMemcpyKind kind, cudaStream_t stream);
cudaError_t cudaMemsetAsync(void* memory, int byte, std::size_t bytes, cudaStream_t stream);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned flags);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t first, cudaEvent_t last);

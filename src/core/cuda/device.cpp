#include "core/cuda/device.hpp"

#include <cuda_runtime_api.h>

#include "core/cuda/check.hpp"
#include "core/cuda/probe.hpp"
#include "core/format_message.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cuda {
namespace {

Device unusable(std::string reason) {
  static_cast<void>(cudaGetLastError());  // said, and not to be said again by the next call
  Device device;
  device.reason = std::move(reason);
  return device;
}

std::string said(cudaError_t status) {
  return cudaGetErrorString(status);
}

}  // namespace

Device find_device() {
  int count = 0;
  if (const cudaError_t status = cudaGetDeviceCount(&count); status != cudaSuccess) {
    int driver = 0;
    if (cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0) return unusable("no NVIDIA driver is installed");
    return unusable("CUDA finds no device: " + said(status));
  }
  if (count == 0) return unusable("CUDA finds no device");
  int index = 0;
  cudaDeviceProp properties{};
  cudaError_t status = cudaGetDevice(&index);
  if (status == cudaSuccess) status = cudaGetDeviceProperties(&properties, index);
  if (status != cudaSuccess) return unusable("the GPU does not answer: " + said(status));
  const std::string name =
      format_message(properties.name, " (compute capability ", properties.major, ".", properties.minor, ")");
  status = cudaFree(nullptr);  // makes the context, for which a GPU may be too busy or its memory too full
  if (status != cudaSuccess) return unusable(format_message("the ", name, " cannot be used now: ", said(status)));
  int code_for = 0;
  if (const cudaError_t code = probe_code(code_for); code != cudaSuccess) {
    return unusable(format_message("this binary carries no code that the ", name, " can run (", said(code),
                                   "): build it with CMAKE_CUDA_ARCHITECTURES=", properties.major, properties.minor));
  }
  Device device;
  device.name = name;
  device.index = index;
  device.multiprocessors = properties.multiProcessorCount;
  device.programmatic_launch = CUDART_VERSION >= 11080 && code_for >= 90;  // only then begin_kernel() waits
  device.usable = true;
  return device;
}

void require_current_device(int index) {
  int current = 0;
  ROADSTEREO_CUDA(cudaGetDevice(&current));
  if (current == index) return;
  fail("what works on GPU ", index, " is used in a thread whose current one is GPU ", current, ": call cudaSetDevice(",
       index, ") there first");
}

}  // namespace roadstereo::cuda

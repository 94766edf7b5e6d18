#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

namespace roadstereo::cuda {

/// Throws SystemError "`call` failed: what CUDA says of it" unless `status` is success.
void check(cudaError_t status, const char* call);

/// Throws Error when a block needs more shared memory than the `most` bytes that the device has for one.
void require_shared_memory(std::size_t bytes, int most);

}  // namespace roadstereo::cuda

/// Calls the CUDA runtime; a failure is thrown with the call's own text.
#define ROADSTEREO_CUDA(call) ::roadstereo::cuda::check((call), #call)

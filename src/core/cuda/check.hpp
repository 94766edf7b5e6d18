#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

namespace roadstereo::cuda {

/// Throws SystemError with the text of CUDA unless `status` is success.
void check(cudaError_t status, const char* call);

/// Throws Error when a block needs more shared memory than the 48 KB that every device has for one.
void require_shared_memory(std::size_t bytes);

}  // namespace roadstereo::cuda

/// Calls the CUDA runtime; throws SystemError naming the call when it fails.
#define ROADSTEREO_CUDA(call) ::roadstereo::cuda::check((call), #call)

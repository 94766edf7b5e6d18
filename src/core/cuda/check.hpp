#pragma once

#include <cuda_runtime_api.h>

namespace roadstereo::cuda {

/// Throws SystemError "`call` failed: what CUDA says of it" unless `status` is success.
void check(cudaError_t status, const char* call);

}  // namespace roadstereo::cuda

/// Calls the CUDA runtime; a failure is thrown with the call's own text.
#define ROADSTEREO_CUDA(call) ::roadstereo::cuda::check((call), #call)

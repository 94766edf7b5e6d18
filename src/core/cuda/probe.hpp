#pragma once

#include <cuda_runtime_api.h>

namespace roadstereo::cuda {

/// Returns the status of a kernel of this binary: an error without code for the current device.
cudaError_t probe_code();

}  // namespace roadstereo::cuda

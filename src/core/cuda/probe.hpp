#pragma once

#include <cuda_runtime_api.h>

namespace roadstereo::cuda {

/// What the runtime says of a kernel of this binary: whether there is code for the current device.
cudaError_t probe_code();

}  // namespace roadstereo::cuda

#pragma once

#include <cuda_runtime_api.h>

namespace roadstereo::cuda {

/// Returns the status of a kernel of this binary: an error without code for the current device. `compute_capability`,
/// times ten, is the one that its code was made for.
cudaError_t probe_code(int& compute_capability);

}  // namespace roadstereo::cuda

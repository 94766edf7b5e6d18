#pragma once

#include "core/cuda/host_device.hpp"

namespace roadstereo {

/// a·b, rounded. Kernels otherwise add the whole product to what comes next, and differ from the host in the last bit.
ROADSTEREO_HD inline double rounded_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  return a * b;
#endif
}

}  // namespace roadstereo

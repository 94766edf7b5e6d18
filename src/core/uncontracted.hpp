#pragma once

#include "core/cuda/host_device.hpp"

namespace roadstereo {

/// a·b, rounded by itself. Compilers for GPUs join a product with the sum it goes into, which rounds once where the
/// host rounds twice; where both must agree to the bit, the product is this.
ROADSTEREO_HD inline float uncontracted_product(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fmul_rn(a, b);
#else
  return a * b;
#endif
}

ROADSTEREO_HD inline double uncontracted_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  return a * b;
#endif
}

}  // namespace roadstereo

#pragma once

#include "roadstereo/host_device.hpp"

// Products that compilers must not contract with a sum into a fused multiply-add (FMA), which rounds once instead of
// twice: for results that are equal to the bit on GPUs, ARM and x86.
#pragma GCC visibility push(default)
namespace roadstereo {

// Prevents FMA contraction on the host: the empty asm makes the product opaque to the optimiser.
#if defined(__CUDA_ARCH__)
#define ROADSTEREO_KEEP_PRODUCT(product)
#elif defined(__FMA__)
#define ROADSTEREO_KEEP_PRODUCT(product) __asm__("" : "+x"(product))
#elif defined(__aarch64__)
#define ROADSTEREO_KEEP_PRODUCT(product) __asm__("" : "+w"(product))
#else
#define ROADSTEREO_KEEP_PRODUCT(product)
#endif

/// Returns a·b rounded, never contracted into an FMA.
ROADSTEREO_HD inline float uncontracted_product(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __fmul_rn(a, b);
#else
  float product = a * b;
  ROADSTEREO_KEEP_PRODUCT(product);
  return product;
#endif
}

ROADSTEREO_HD inline double uncontracted_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  double product = a * b;
  ROADSTEREO_KEEP_PRODUCT(product);
  return product;
#endif
}

#undef ROADSTEREO_KEEP_PRODUCT

}  // namespace roadstereo
#pragma GCC visibility pop

#pragma once

#include "core/cuda/host_device.hpp"

// Compilers join a product with the sum it goes into where the hardware has an operation for both: for GPUs, for ARM,
// for x86 with FMA. That rounds once where other machines round twice. Where all must agree to the bit, the product is
// one of these.
namespace roadstereo {

// Where the host's compiler may join: the product passes through a register that it does not look into.
#if defined(__CUDA_ARCH__)
#define ROADSTEREO_KEEP_PRODUCT(product)
#elif defined(__FMA__)
#define ROADSTEREO_KEEP_PRODUCT(product) __asm__("" : "+x"(product))
#elif defined(__aarch64__)
#define ROADSTEREO_KEEP_PRODUCT(product) __asm__("" : "+w"(product))
#else
#define ROADSTEREO_KEEP_PRODUCT(product)
#endif

/// a·b, rounded by itself.
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

#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Tukey's constant: 95 % efficiency for normal residuals.
inline constexpr double tukey = 4.685;

/// Tukey's biweight, 0 … 1; `x` is the residual in windows of tukey · scale.
template <class Real>
ROADSTEREO_HD Real tukey_weight(Real x) {
  const Real rest = 1 - x * x;
  return rest > 0 ? rest * rest : Real{0};
}

}  // namespace roadstereo

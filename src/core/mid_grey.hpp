#pragma once

#include "roadstereo/grey_scale.hpp"

namespace roadstereo {

/// Half of white. Subtracted from every grey value it changes no covariance, and keeps the sums of products of the
/// largest block in 32 bits.
inline constexpr int mid_grey = grey_max / 2;

}  // namespace roadstereo

#pragma once

namespace roadstereo {

/// Subtracted from every grey value: keeps the sums of products of the largest block in 32 bits, and changes no
/// covariance. Half of grey_max.
inline constexpr int mid_grey = 255 * 16 / 2;

}  // namespace roadstereo

#pragma once

#include <cstddef>
#include <span>

#include "roadstereo/damage.hpp"

// Zero-mean normalised cross-correlation (ZNCC) of 5×5 blocks of the left image with the right one, along the measured
// disparities and along the undamaged road.

namespace roadstereo {

inline constexpr int block_radius = 2;
inline constexpr std::size_t block_side = 2 * block_radius + 1;
inline constexpr std::size_t block_pixels = block_side * block_side;

/// Whether the input has both images and a disparity map.
inline bool has_blocks(const DamageInput& input) {
  return !input.right.empty() && !input.grey.empty() && !input.disparity.empty();
}

/// Votes of the blocks around the pixels `u` of row v: log of the likelihood ratio of the measured surface to the road
/// at `surface`, from their correlations, truncated and scaled to [−1, 1]; 0 if either is unknown.
void vote_for_blocks(const DamageInput& input, int v, std::span<const int> u, std::span<const float> surface,
                     std::span<float> votes);

}  // namespace roadstereo

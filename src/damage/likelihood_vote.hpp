#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadstereo {

/// Log likelihood of pixels that correlate so along a surface, but for a constant: grey levels differ by normal noise.
inline float log_likelihood(float correlation, std::size_t pixels) {
  constexpr float min_noise_share = 1e-4F;
  return -0.5F * static_cast<float>(pixels) * std::log(std::max(1 - correlation * correlation, min_noise_share));
}

/// Vote of pixels for one surface against another, −1 … 1: the truncated log of their likelihood ratio. 0 if a
/// correlation is NaN.
inline float likelihood_vote(float along_one, float along_other, std::size_t pixels) {
  constexpr float max_log_ratio = 2;  // an object that one camera alone sees counts no more than a block of the road
  const float log_ratio = log_likelihood(along_one, pixels) - log_likelihood(along_other, pixels);
  return std::isnan(log_ratio) ? 0 : std::clamp(log_ratio / max_log_ratio, -1.0F, 1.0F);
}

}  // namespace roadstereo

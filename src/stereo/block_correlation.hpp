#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

// Matching cost, eq. (8): one minus the normalised cross-correlation of two blocks. C++17, for kernels.

/// Variance of a block (fixed-point grey²) below which its cost is 1: half a step of standard deviation is no texture.
constexpr float min_variance = 0.25F;

/// One view's part of a block of n pixels, of grey levels less mid-grey: S = n·mean + residue, mean whole. Aligned, so
/// that a GPU reads it in one piece.
struct alignas(16) BlockPart {
  int sum;                  ///< S = Σ i
  int mean;                 ///< S / n, rounded
  float residue;            ///< S − n·mean
  float inverse_deviation;  ///< 1 / √(σ² + noise²), 0 where there is no texture
};

/// From S and Q = Σ i²: n·σ² = Q − mean·(S + e) − e² / n, e the residue; whole numbers up to the last term.
ROADSTEREO_HD inline BlockPart block_part(int sum, int square, int pixels, float noise_variance) {
  const float inverse_n = 1.0F / static_cast<float>(pixels);
  const int mean = static_cast<int>(rintf(static_cast<float>(sum) * inverse_n));
  const int residue = sum - mean * pixels;
  const auto e = static_cast<float>(residue);
  const float variance = (static_cast<float>(square - mean * (sum + residue)) - e * e * inverse_n) * inverse_n;
  return {sum, mean, e, variance >= min_variance ? 1.0F / sqrtf(variance + noise_variance) : 0.0F};
}

/// The matching cost c(p, d) of eq. (8): 1 − n·cov / (n σ_own σ_other), from Σ own·other and 1 / n.
/// n·cov = (Σ own·other − S_own·mean_other) − S_own / n·residue_other, the bracket in whole numbers.
ROADSTEREO_HD inline float correlation_cost(const BlockPart& own, const BlockPart& other, int product,
                                            float inverse_n) {
  const float inverse = own.inverse_deviation * other.inverse_deviation * inverse_n;
  const auto whole = static_cast<float>(product - own.sum * other.mean);
  return 1.0F - (whole - static_cast<float>(own.sum) * inverse_n * other.residue) * inverse;
}

}  // namespace roadstereo

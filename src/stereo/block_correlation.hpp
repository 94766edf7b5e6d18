#pragma once

#include <cmath>

#include "core/cuda/host_device.hpp"

namespace roadstereo {

/// A block whose variance (fixed-point grey²) is below this has no texture: its cost is 1.
constexpr float smallest_variance = 0.25F;

/// Sums over the part of a block that both views see: whole numbers, of grey levels less mid-grey.
struct BlockSums {
  int columns;
  int own, own_square;
  int other, other_square;
  int product;
};

/// One view's part of a block of n pixels: S = n·mean + residue, mean whole.
struct BlockMean {
  int mean;
  int residue;
};

ROADSTEREO_HD inline BlockMean block_mean(int sum, int pixels, float inverse_n) {
  const int mean = static_cast<int>(rintf(static_cast<float>(sum) * inverse_n));
  return {mean, sum - mean * pixels};
}

/// 1 / √(σ² + noise²) of a block, 0 where there is no texture, from S = n·mean + e and Q = Σ i²:
/// n·σ² = Q − mean·(S + e) − e² / n, whole numbers up to the last term.
ROADSTEREO_HD inline float inverse_deviation(int sum, int square, const BlockMean& of, float inverse_n,
                                             float noise_variance) {
  const auto whole = static_cast<float>(square - of.mean * (sum + of.residue));
  const auto e = static_cast<float>(of.residue);
  const float variance = (whole - e * e * inverse_n) * inverse_n;
  return variance >= smallest_variance ? 1.0F / sqrtf(variance + noise_variance) : 0.0F;
}

/// The matching cost c(p, d) of eq. c: 1 − n·cov / (n σ_own σ_other), the noise added to the deviations.
/// n·cov = (Σ own·other − S_own·mean_other) − S_own / n·residue_other, the bracket in whole numbers.
ROADSTEREO_HD inline float correlation_cost(const BlockSums& sums, int rows, float noise_variance) {
  const int n = sums.columns * rows;
  const float inverse_n = 1.0F / static_cast<float>(n);
  const BlockMean own = block_mean(sums.own, n, inverse_n), other = block_mean(sums.other, n, inverse_n);
  const float inverse = inverse_deviation(sums.own, sums.own_square, own, inverse_n, noise_variance) *
                        inverse_deviation(sums.other, sums.other_square, other, inverse_n, noise_variance) * inverse_n;
  const auto whole = static_cast<float>(sums.product - sums.own * other.mean);
  const float covariance = whole - static_cast<float>(sums.own) * inverse_n * static_cast<float>(other.residue);
  return 1.0F - covariance * inverse;
}

}  // namespace roadstereo

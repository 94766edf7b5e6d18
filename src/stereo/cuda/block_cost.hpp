#pragma once

#include <cmath>

#include "core/cuda/host_device.hpp"
#include "stereo/block_correlation.hpp"
#include "stereo/mid_grey.hpp"

// The matching cost of a pair of blocks from sums of whole numbers (eq. c), as the kernels compute it.

namespace roadstereo::cuda {

/// Sums over the rows of a block at one column: of the grey values less mid-grey, and of their squares.
struct ColumnSums {
  int sum;
  int squares;
};

/// A block of n pixels: S = n (mean + fraction), mean whole; 1 / (σ √n), 0 where the block has no texture.
struct alignas(16) BlockStatistics {
  float inverse;
  float fraction;
  int mean;
  int sum;
};

ROADSTEREO_HD inline BlockStatistics block_statistics(int n, int sum, int squares, float noise_variance) {
  const float inverse_n = 1.0F / static_cast<float>(n);
  const BlockMean of = block_mean(sum, n, inverse_n);
  const float inverse = inverse_deviation(sum, squares, of, inverse_n, noise_variance) * sqrtf(inverse_n);
  return {inverse, static_cast<float>(of.residue) * inverse_n, of.mean, sum};
}

/// 1 − n·cov / (n σ_own σ_other), where n·cov = (Σ own·other − S_own·mean_other) − S_own·fraction_other: the bracket is
/// exact in whole numbers, and no larger than 32 bits hold.
ROADSTEREO_HD inline float block_cost(int products, const BlockStatistics& own, const BlockStatistics& other) {
  const auto bracket =
      static_cast<unsigned>(products) - static_cast<unsigned>(own.sum) * static_cast<unsigned>(other.mean);
  const float covariance = static_cast<float>(static_cast<int>(bracket)) - static_cast<float>(own.sum) * other.fraction;
  return 1.0F - covariance * own.inverse * other.inverse;
}

}  // namespace roadstereo::cuda

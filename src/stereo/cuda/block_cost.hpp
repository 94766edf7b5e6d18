#pragma once

#include <cmath>
#include <cstdint>

#include "core/cuda/host_device.hpp"

// The matching cost of a pair of blocks from sums of whole numbers (eq. c), as the kernels compute it.

namespace roadstereo::cuda {

/// Subtracted from every grey value: keeps the sums of products in 32 bits and changes no covariance.
constexpr int mid_grey = 255 * 16 / 2;

/// Below half a fixed-point step of standard deviation a block has no texture.
constexpr double smallest_variance = 0.25;

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
  const std::int64_t scatter = std::int64_t{n} * squares - std::int64_t{sum} * sum;  // n² σ², exact
  const float pixels = static_cast<float>(n);
  // Half up: floor division of a number made positive.
  const int mean = (sum + n * (2 * mid_grey) + n / 2) / n - 2 * mid_grey;
  BlockStatistics block;
  block.mean = mean;
  block.sum = sum;
  block.fraction = static_cast<float>(sum - n * mean) / pixels;
  const double least = smallest_variance * n * n;
  const float variance = static_cast<float>(scatter) / (pixels * pixels) + noise_variance;
  block.inverse = static_cast<double>(scatter) < least ? 0.0F : 1.0F / sqrtf(variance * pixels);
  return block;
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

#pragma once

#include <cstddef>
#include <cstdint>

#include "stereo/block_correlation.hpp"

// Vector kernels for the matching cost c(p, d) of eq. (8). They work on one row of a view, whose pixels are called
// "own"; the other view's row is stored in the opposite direction, so that the candidates d = 0, 1, … of an own pixel
// lie one behind the other: a vector holds the disparities of one pixel.
//
// Own column i and disparity d meet the other column `origin` − i + d. Where a row of numbers has one for every column
// and disparity, those of column i begin at i·pitch.

namespace roadstereo::cpu {

/// Disparities are padded to a multiple of this: the widest vector has so many lanes.
inline constexpr int disparity_grid = 16;
constexpr std::ptrdiff_t padded_disparities(std::ptrdiff_t disparities) {
  return (disparities + disparity_grid - 1) / disparity_grid * disparity_grid;
}

/// Two samples of one column as one number: the row that enters the block and the row that leaves it.
using SamplePair = std::int32_t;

/// Column sums of one view over the rows of a block.
struct ColumnSums {
  std::int32_t* sum;     ///< Σ i
  std::int32_t* square;  ///< Σ i²
};

/// Moves the column sums by one row: + entering − leaving. Writes the pairs that slide_products wants: (entering,
/// leaving) for the own view, (entering, −leaving) for the other, as `sign` is 1 or −1.
void slide_sums(const std::int16_t* entering, const std::int16_t* leaving, int first, int end, int sign,
                const ColumnSums& sums, SamplePair* pairs);

/// products[i, d] += entering own·other − leaving own·other, for own columns first … end − 1.
void slide_products(const SamplePair* own, const SamplePair* other, int origin, int first, int end, int disparities,
                    std::ptrdiff_t pitch, std::int32_t* products);

/// Statistics of the blocks around the columns of one row, in fixed-point grey: S = n·mean + residue, mean whole.
struct BlockStatistics {
  std::int32_t* sum;         ///< S = Σ i
  std::int32_t* mean;        ///< S / n, rounded
  float* residue;            ///< S − n·mean
  float* inverse_deviation;  ///< 1 / √(σ² + noise²), 0 where the block has no texture
};

/// Statistics at the columns first … end − 1. Columns whose block leaves the image get figures of no meaning.
void block_statistics(const ColumnSums& sums, int block_radius, int pixels, float noise_variance, int first, int end,
                      const BlockStatistics& out);

/// What the cost kernels see of one row. Costs are wanted of every `step`-th of the columns first … end − 1, around
/// which there are block_radius columns more; those of column i begin at (i − block_radius) / step·pitch.
struct CostRow {
  int first, end;
  int step;           ///< 1 or 2
  int first_visible;  ///< column i sees the other view from disparity 0 to i − first_visible
  int last_valid;     ///< last column of the own view
  int block_radius;
  int block_rows;  ///< rows of the block that lie in the image
  int disparities;
  std::ptrdiff_t pitch;
  int origin;  ///< own column i and disparity d meet other column origin − i + d
  float noise_variance;
  const std::int32_t* products;  ///< column sums of own·other, pitch elements a column
  BlockStatistics own, other;
};

/// cost[i, d] = 1 − n·cov / (n σ_own σ_other) wherever the common view does not clip the block. Exact up to the last
/// steps: n·cov = (Σ own·other − S_own·mean_other) − S_own / n·residue_other, the bracket in whole numbers.
void full_block_costs(const CostRow& row, float* cost);

/// Running sums of the column sums of both views: element k holds the sum over the columns before k, and behind the end
/// of the other view it stays what it is.
struct RunningSums {
  const std::int32_t *own_sum, *own_square, *other_sum, *other_square;
};

/// The same cost everywhere else, over the part of the block that both views see; 0 where a pixel has no counterpart.
void clipped_block_costs(const CostRow& row, const RunningSums& running, float* cost);

}  // namespace roadstereo::cpu

#pragma once

#include <cstddef>
#include <cstdint>

#include "road/disparity_evidence.hpp"

namespace roadstereo {

// Wide and flat blocks: on a road seen at a slant the disparity changes from row to row, not along them.
inline constexpr int row_block_half_width = 5;
inline constexpr int row_block_half_height = 2;
inline constexpr int row_block_pixels = (2 * row_block_half_width + 1) * (2 * row_block_half_height + 1);

/// Elements before and behind every row that are read, and without effect when they are 0.
inline constexpr std::ptrdiff_t row_guard = 16;

/// The blocks along a row, each of n = row_block_pixels pixels: n·mean + n·residue = sum, sum and mean whole, so that
/// no covariance is the difference of two large rounded numbers, however bright the image is.
struct BlockRow {
  std::int32_t* sum;         ///< of the grey levels
  std::int32_t* mean;        ///< grey level, rounded
  float* residue;            ///< of the mean, −½ … ½ grey level
  float* inverse_deviation;  ///< 1 / standard deviation; 0 where there is no texture or no whole block
};

/// How well the blocks of a left row correlate with those of the right one; disparity d of column u at
/// values[d·pitch + u]. A block without a counterpart has −1.
struct RowCorrelations {
  float* values;
  std::ptrdiff_t pitch;
  int width;
  int disparities;
};

/// The best of each column's disparities. Equal ones: the smallest.
struct BestOfRow {
  float* correlation;
  float* disparity;  ///< a whole number
};

/// Adds the products of two rows' columns to sums[d·pitch + u]; subtracts them when `sign` is −1. `right` must be
/// readable, and 0, for `disparities` columns before its first.
void add_products(const std::int16_t* left, const std::int16_t* right, const RowCorrelations& row, int sign,
                  std::int32_t* sums);

/// Turns the columns' sums of products into correlations, and keeps the best of the left columns and of the right ones.
/// `sums` must be readable, and 0, for row_guard elements on either side.
void correlate_row(const std::int32_t* sums, const BlockRow& left, const BlockRow& right, const RowCorrelations& row,
                   const BestOfRow& best_of_left, const BestOfRow& best_of_right);

/// The highest correlation of each left column among the disparities that are no neighbours of the best: more than two
/// away from it.
void find_rivals(const RowCorrelations& row, const float* best_disparity, float* rivals);

/// Adds to `cell` the evidence of the pixels from column `first` on: the posterior of each disparity,
/// P(d) ∝ (1 − ρ²)^−6 with ρ the positive part of the correlation, against that of a disparity drawn at random.
/// `posterior` is memory for disparities × evidence_columns values.
void add_evidence(const RowCorrelations& row, int first, float* posterior, const EvidenceCell& cell);

}  // namespace roadstereo

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// The vector kernels of the cpu engine: each works on one row of the image, for the instruction set of this machine.
// Pointers to rows point at column 0; rows have at least `row_padding` readable elements on either side.

namespace roadstereo::cpu {

/// Elements that kernels may read before the first and behind the last column of a row.
inline constexpr int row_padding = 64;

/// A block whose variance (fixed-point grey²) is below this has no texture: its cost is 1.
inline constexpr float smallest_variance = 0.25f;

/// Block sums of one view at one row, in fixed-point grey: sum = n·mean + residue with a whole mean.
struct BlockStatistics {
  const std::int32_t* sum;
  const std::int32_t* mean;
  const std::int32_t* residue;
  const float* inverse_deviation;  ///< 1 / (n·√(σ² + noise²)), 0 where the block has no texture
};

/// sums[u] += entering_ref[u]·entering_tar[u] − leaving_ref[u]·leaving_tar[u] for u in [first, end).
void slide_products(const std::int16_t* entering_ref, const std::int16_t* entering_tar, const std::int16_t* leaving_ref,
                    const std::int16_t* leaving_tar, int first, int end, std::int32_t* sums);

/// The same as block_statistics writes it.
struct BlockStatisticsRow {
  std::int32_t* sum;
  std::int32_t* mean;
  std::int32_t* residue;
  float* inverse_deviation;
};

/// Block statistics of one view at the columns [first, end), from the column sums of i and i². `noise_variance` is
/// added to σ². Columns whose block leaves the image get figures of no meaning.
void block_statistics(const std::int32_t* column_sums, const std::int32_t* column_squares, int block_radius,
                      int pixels_in_block, float noise_variance, int first, int end, const BlockStatisticsRow& out);

/// cost[u] = 1 − n·cov(u) / (n σ_ref σ_tar), eq. c, for u in [first, last], from the column sums of i_ref·i_tar.
/// `tar` is shifted so that tar.sum[u] belongs to the target pixel that u is compared with. Exact up to the last step:
/// n·cov = S_rt − S_r·S_t / n is taken in integers as S_rt − m_r·e_t − m_t·S_r, minus the small e_r·e_t / n.
void correlation_row(const std::int32_t* column_sums, const BlockStatistics& ref, const BlockStatistics& tar,
                     int block_radius, int pixels_in_block, int first, int last, float* cost);

/// One neighbour of the pixels of a row. Its arrays begin at column 0 of the neighbour's row.
struct RowTap {
  const float* cost;         ///< matching costs, plane d = 0
  const std::int16_t* grey;  ///< of the view that is aggregated
  int du;                    ///< columns to the right of the pixel
  int first_column;          ///< first valid target column of the neighbour's row
  float log2_weight;         ///< log2 ω0
};

/// One row of one view, ready to be aggregated at the columns [begin, end).
struct AggregationRow {
  int begin = 0;
  int end = 0;
  int width = 0;
  int disparities = 0;
  int radius = 0;
  std::ptrdiff_t plane = 0;            ///< elements from disparity d to d + 1 in the costs
  int shift = 0;                       ///< 0 reference view; 1 target view: column x has the cost at x + d
  float colour_log2 = 0;               ///< log2 ω1 = colour_log2 · (difference in fixed-point grey)²
  const std::int16_t* grey = nullptr;  ///< the row itself
  int first_column = 0;                ///< its first valid target column
  int common_first_column = 0;         ///< the largest of all rows of the window
  std::span<const RowTap> taps;        ///< those whose rows lie inside the image
};

/// Column that a row may be cut at without changing its results: vectors begin at its multiples.
inline constexpr int column_grid = 64;

/// What winner-take-all leaves of one row.
struct WinnerRow {
  std::int16_t* winner;  ///< −1 where nothing can match
  float* offset;         ///< eq. subpixel; NaN when the winner has no neighbour on one side; null: not wanted
};

/// Floats of scratch memory that choose_row needs for a window of `taps` taps.
std::size_t choose_row_scratch(std::size_t taps);

/// Aggregates the costs (eq. fbs) and takes the winner at every pixel of the row's columns, with its sub-pixel offset.
/// `row.begin` must be a multiple of `column_grid`.
void choose_row(const AggregationRow& row, float* scratch, const WinnerRow& winners);

std::string target_name();

}  // namespace roadstereo::cpu

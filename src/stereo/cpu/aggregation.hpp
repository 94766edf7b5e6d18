#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// Vector kernel for aggregation (eq. (11)) and winner-take-all: a vector holds the disparities of one pixel, so that
// every load is aligned and a tap's weight is one number for all of them.

namespace roadstereo::cpu {

/// Columns that are aggregated together; a tile begins at a multiple of this, so that tiles change no result.
inline constexpr int strip_columns = 32;

/// One row of the aggregation window: the taps −half … half around the pixel's column, `step` columns apart.
struct WindowRow {
  const float* costs;  ///< c(p, d) of the row: column i, disparity d at i·pitch + d
  int half;
  int first_visible;  ///< column i sees the other view from disparity 0 to i − first_visible
  int last_valid;     ///< last column of the own view
};

/// What winner-take-all leans on: energies at disparity d grow by slope · min(|d − centre|, reach).
struct PriorRow {
  const float* centre = nullptr;  ///< per column of the tile; NaN: nothing to lean on there; null: nowhere
  float weight = 0;
  float truncation = 0;
};

/// One row of one view, ready to be aggregated at the columns [first, end).
struct AggregationRow {
  int first;
  int end;
  int disparities;
  std::ptrdiff_t pitch;
  int step;                               ///< columns from one tap to the next, 1 or 2
  int radius;                             ///< columns that the window reaches
  WindowRow centre;                       ///< the window row of the pixels themselves
  std::span<const WindowRow> rows;        ///< those that lie in the image
  std::span<const float* const> weights;  ///< ω of every tap, row by row: weights[tap][column]
  PriorRow prior;
  float effective_samples = 1;  ///< pixels that an energy rests on
};

/// What winner-take-all leaves of the columns [first, end), from index 0 on; whole strips are written.
struct WinnerRow {
  std::int16_t* winner;  ///< −1 where nothing can match
  float* offset;         ///< eq. (13); NaN when the winner has no neighbour on one side; null: not wanted
  float* variance;       ///< of the disparity, pixels²; infinite where the costs do not tell; wanted with `offset`
};

/// Scratch memory of aggregate_and_choose; `numbers` is aligned for vectors.
struct AggregationScratch {
  const float** pointers;
  float* numbers;
};
struct AggregationScratchSize {
  std::ptrdiff_t pointers;
  std::ptrdiff_t numbers;
};
AggregationScratchSize aggregation_scratch(int window_rows, int taps, std::ptrdiff_t pitch);

/// Aggregates the costs (eq. (11)) and takes the winner at every column, with its sub-pixel offset. `row.first` must be
/// a multiple of strip_columns.
void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out);

/// The instruction set that the kernels use on this machine.
std::string target_name();

}  // namespace roadstereo::cpu

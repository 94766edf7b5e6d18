#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// Bilateral aggregation, eq. (11), and winner-take-all by vector kernels: a vector holds the disparities of one pixel,
// so that every load is aligned and a tap's weight is one number for all of them.

namespace roadstereo::cpu {

/// Columns that are aggregated together; a tile begins at a multiple of this, so that tiles change no result.
inline constexpr int strip_columns = 32;

/// One row of the aggregation window: the taps −half … half around the pixel's column, `step` columns apart. Columns
/// are counted in matched pixels: column i is pixel_step·i pixels right of the tile's first.
struct WindowRow {
  const float* costs;  ///< c(p, d) of the row: column i, disparity d at i·pitch + d
  int half;
  int first_visible;  ///< pixel x sees the other view from disparity 0 to x − first_visible
  int last_valid;     ///< last pixel of the own view
};

/// Prior of winner-take-all: energies at disparity d grow by weight · min(distance of d from low … high, truncation).
struct PriorRow {
  const float* low = nullptr;  ///< per column of the tile, whole strips; NaN: unknown; null: no prior
  const float* high = nullptr;
  float weight = 0;
  float truncation = 0;
};

/// One row of one view, ready to be aggregated at the columns [first, end).
struct AggregationRow {
  int first;
  int end;
  int disparities;
  std::ptrdiff_t pitch;
  int pixel_step;                         ///< pixels from one column to the next
  int step;                               ///< columns from one tap to the next, 1 or 2
  int radius;                             ///< of the window, columns
  WindowRow centre;                       ///< the window row of the pixels themselves
  std::span<const WindowRow> rows;        ///< window rows inside the image
  std::span<const float* const> weights;  ///< ω of every tap, row by row: weights[tap][column]
  PriorRow prior;
  float effective_samples = 1;  ///< of an energy (stereo/window.hpp)
  float peak_floor = 0;         ///< of the offset (stereo/window.hpp)
};

/// Output of winner-take-all for the columns [first, end), from index 0 on; whole strips are written.
struct WinnerRow {
  std::int16_t* winner;  ///< −1 where nothing can match
  float* offset;         ///< from the winner; NaN when the winner has no neighbour on one side; null: not written
  float* variance;       ///< of the disparity, pixels²; infinite where undetermined; written with `offset`
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

/// Aggregates the costs, eq. (11), and takes the winner at every column, with its sub-pixel offset. `row.first` must be
/// a multiple of strip_columns.
void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out);

/// The instruction set that the kernels use on this machine.
std::string target_name();

}  // namespace roadstereo::cpu

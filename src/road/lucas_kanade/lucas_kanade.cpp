#include "roadstereo/lucas_kanade.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/lucas_kanade/alignment_maps.hpp"
#include "road/lucas_kanade/sample_rows.hpp"
#include "road/lucas_kanade/settings.hpp"
#include "road/lucas_kanade/window_sums.hpp"
#include "road/row_shift.hpp"

namespace roadstereo {
namespace {

/// Sums of the cells: every row of cells has `alignment_sum_count` rows of numbers, one for each sum.
struct CellSums {
  int columns, rows;
  ScratchVector<float> numbers;

  CellSums(int width, int height)
      : columns(alignment_cells(width)),
        rows(alignment_cells(height)),
        numbers(scratch_vector<float>(row_numbers(columns) * static_cast<std::size_t>(rows))) {}
  static std::size_t row_numbers(int columns) { return alignment_sum_count * static_cast<std::size_t>(columns); }
  float* row(int j) { return numbers.data() + row_numbers(columns) * static_cast<std::size_t>(j); }
  const float* row(int j) const { return numbers.data() + row_numbers(columns) * static_cast<std::size_t>(j); }
};

/// Rows of one worker, with guards.
class WorkerRows {
 public:
  /// Rows: reference, target, disparity, and the sums.
  static constexpr std::size_t count = 3 + alignment_sum_count;

  static std::size_t pitch(int width) { return static_cast<std::size_t>(width) + std::size_t{2} * sample_guard; }

  WorkerRows(float* memory, int width) : memory_(memory), width_(width), pitch_(pitch(width)) {}

  void clear_sums() { std::fill_n(row(3) - sample_guard, alignment_sum_count * pitch_, 0.0F); }

  /// Add the samples of row v to the sums.
  void add(const TransformedPair& pair, ImageView<const float> disparity, int v) {
    prefilter_row(pair.reference.row(v), width_, row(0));
    prefilter_row(pair.target.row(v), width_, row(1));
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    std::copy_n(disparity.row(v), width_, row(2));
    std::fill_n(row(2) + width_, sample_guard, none);
    if (!pair.mask.empty()) leave_out_beside(pair.mask.row(v));
    const int first = pair.first_column != nullptr ? pair.first_column[v] : 0;
    const SampleRow samples{row(0), row(1), row(2), first, width_, shift_line(pair.shift, v)};
    add_samples(samples, static_cast<std::ptrdiff_t>(pitch_), row(3));
  }

  /// Sums of the cells of a row.
  void sum_cells(int columns, float* cells) {
    const int whole = width_ / alignment_cell;
    for (std::size_t k = 0; k < alignment_sum_count; ++k, cells += columns) {
      const float* at = row(3) + k * pitch_;
      for (int cell = 0; cell < whole; ++cell, at += alignment_cell) cells[cell] = (at[0] + at[1]) + (at[2] + at[3]);
      if (whole < columns) cells[whole] = std::accumulate(at, at + width_ % alignment_cell, 0.0F);
    }
  }

 private:
  float* row(std::size_t k) { return memory_ + k * pitch_ + sample_guard; }

  /// Pixels whose filtered grey levels or gradients take in masked ones give no sample.
  void leave_out_beside(const std::uint8_t* mask) {
    constexpr int reach = prefilter_radius + 1;
    for (int u = 0; u < width_; ++u) {
      if (mask[u] == 0) continue;
      const int first = std::max(0, u - reach), last = std::min(width_ - 1, u + reach);
      std::fill(row(2) + first, row(2) + last + 1, std::numeric_limits<float>::quiet_NaN());
    }
  }

  float* memory_;
  int width_;
  std::size_t pitch_;
};

/// Sums of the windows of a row of cells.
class WindowSums {
 public:
  static std::size_t numbers(int columns) { return 2 * CellSums::row_numbers(columns); }

  WindowSums(double* memory, int columns)
      : columns_(columns), of_rows_(memory), sums_(memory + CellSums::row_numbers(columns)) {}

  /// Add up the cells that are up to `radius` rows and columns away from those of row j.
  void add_up(const CellSums& cells, int j, int radius) {
    const auto count = static_cast<int>(CellSums::row_numbers(columns_));
    const int first = std::max(0, j - radius), last = std::min(cells.rows - 1, j + radius);
    sum_rows(cells.row(first), count, last - first + 1, count, of_rows_);
    for (int k = 0; k < static_cast<int>(alignment_sum_count); ++k) {
      const std::ptrdiff_t at = std::ptrdiff_t{k} * columns_;
      sum_columns(of_rows_ + at, columns_, radius, sums_ + at);
    }
  }

  AlignmentSums<double> of_column(int i) const {
    const auto sum = [this, i](int k) { return sums_[static_cast<std::ptrdiff_t>(k) * columns_ + i]; };
    return {sum(0), sum(1), sum(2), sum(3), sum(4), sum(5), sum(6), sum(7), sum(8), sum(9)};
  }

 private:
  int columns_;
  double *of_rows_, *sums_;
};

/// Shifts of the cells, with one more on either side that repeats the outermost.
struct CellShifts {
  int columns, rows;
  ScratchVector<float> numbers;

  CellShifts(int width, int height)
      : columns(alignment_cells(width)),
        rows(alignment_cells(height)),
        numbers(scratch_vector<float>(static_cast<std::size_t>(columns + 2) * static_cast<std::size_t>(rows))) {}
  float* row(int j) { return numbers.data() + std::ptrdiff_t{j} * (columns + 2) + 1; }
  void repeat_outermost(int j) {
    float* const shifts = row(j);
    shifts[-1] = shifts[0];
    shifts[columns] = shifts[columns - 1];
  }
};

/// Adds `scale` times the shifts, interpolated between the cells, to row v. `line`: room for a row of shifts.
void add_shifts(CellShifts& shifts, float scale, int v, const float* disparity, int width, float* line,
                float* aligned) {
  const CellPlace row = cell_place(v, shifts.rows);
  const float *const above = shifts.row(row.first) - 1, *const below = shifts.row(row.second) - 1;
  for (int i = 0; i < shifts.columns + 2; ++i) line[i] = scale * (above[i] + row.share * (below[i] - above[i]));
  constexpr int half = alignment_cell / 2;
  // Between the middles of two cells the shift is linear: half a cell of the one, and half of the other.
  for (int i = 0; i <= shifts.columns; ++i) {
    const float first = line[i], slope = (line[i + 1] - first) / alignment_cell;
    const int begin = i * alignment_cell - half;
    for (int k = std::max(0, -begin); k < std::min(alignment_cell, width - begin); ++k) {
      aligned[begin + k] = disparity[begin + k] + (first + (static_cast<float>(k) + 0.5F) * slope);
    }
  }
}

void require_sizes(const TransformedPair& pair, ImageView<const float> disparity) {
  const ImageSize size = map_size(disparity);
  require_same_size("the disparity map", size, "the reference image", map_size(pair.reference));
  require_same_size("the disparity map", size, "the target image", map_size(pair.target));
  require_mask_size(map_size(pair.mask), size);
}

}  // namespace

void LucasKanadeOptions::validate() const {
  require_range("lucas_kanade", "radius", radius, 0, 8);
  require_range("lucas_kanade", "bias_sigma_px", bias_sigma_px, 0.001, 10.0);
  require_range("lucas_kanade", "max_shift_px", max_shift_px, 0.01, 2.0);
}

void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned) {
  if (options.radius == 0) {
    options.validate();
    require_sizes(pair, disparity);
    aligned.resize(disparity.width(), disparity.height());
    for (int v = 0; v < disparity.height(); ++v) std::copy_n(disparity.row(v), disparity.width(), aligned.row(v));
    return;
  }
  Image<float> correlation;
  lucas_kanade(pair, disparity, options, threads, aligned, correlation);
}

void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned, Image<float>& correlation) {
  options.validate();
  require_sizes(pair, disparity);
  const int width = disparity.width(), height = disparity.height();
  constexpr int rows_per_band = 8;  // of cells
  const auto workers = static_cast<std::size_t>(resolve_threads(threads));
  const std::size_t row_numbers = WorkerRows::count * WorkerRows::pitch(width);
  auto memory = scratch_vector<float>(row_numbers * workers);
  CellSums cells(width, height);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    WorkerRows rows(memory.data() + row_numbers * static_cast<std::size_t>(worker), width);
    for (int j = first; j < last; ++j) {
      rows.clear_sums();
      const int end = std::min((j + 1) * alignment_cell, height);
      for (int v = j * alignment_cell; v < end; ++v) rows.add(pair, disparity, v);
      rows.sum_cells(cells.columns, cells.row(j));
    }
  });
  CellShifts shifts(width, height);
  correlation.resize(cells.columns, cells.rows);
  const AlignmentSettings settings = alignment_settings(options);
  const std::size_t window_numbers = WindowSums::numbers(cells.columns);
  auto window_memory = scratch_vector<double>(window_numbers * workers);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    WindowSums windows(window_memory.data() + window_numbers * static_cast<std::size_t>(worker), cells.columns);
    for (int j = first; j < last; ++j) {
      windows.add_up(cells, j, options.radius);
      for (int i = 0; i < cells.columns; ++i) {
        const AlignmentSums<double> sums = windows.of_column(i);
        shifts.row(j)[i] = alignment_shift(sums, settings);
        correlation(i, j) = alignment_correlation(sums);
      }
      shifts.repeat_outermost(j);
    }
  });
  aligned.resize(width, height);
  const float scale = 1 - shift_line(pair.shift, 0).slope;  // d disparity / d residual
  parallel_rows(height, rows_per_band * alignment_cell, threads, [&](int first, int last, int worker) {
    float* const line = memory.data() + static_cast<std::size_t>(cells.columns + 2) * static_cast<std::size_t>(worker);
    for (int v = first; v < last; ++v) add_shifts(shifts, scale, v, disparity.row(v), width, line, aligned.row(v));
  });
}

}  // namespace roadstereo

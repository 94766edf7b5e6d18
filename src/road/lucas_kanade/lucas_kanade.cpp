#include "roadstereo/lucas_kanade.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/scratch.hpp"
#include "road/lucas_kanade/sample_rows.hpp"
#include "road/lucas_kanade/settings.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

using Sums = AlignmentSums<double>;

/// Cells of a map: rows of `columns`.
template <class Cell>
struct CellMap {
  int columns, rows;
  ScratchVector<Cell> cells;

  CellMap(int width, int height)
      : columns(alignment_cells(width)),
        rows(alignment_cells(height)),
        cells(scratch_vector<Cell>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))) {}
  Cell* row(int j) { return cells.data() + static_cast<std::ptrdiff_t>(j) * columns; }
  const Cell* row(int j) const { return cells.data() + static_cast<std::ptrdiff_t>(j) * columns; }
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
    std::copy_n(disparity.row(v), width_, row(2));
    std::fill_n(row(2) + width_, sample_guard, std::numeric_limits<float>::quiet_NaN());
    const int first = pair.first_column != nullptr ? pair.first_column[v] : 0;
    const SampleRow samples{row(0), row(1), row(2), first, width_, shift_line(pair.shift, v)};
    add_samples(samples, static_cast<std::ptrdiff_t>(pitch_), row(3));
  }

  /// Sums of the cells.
  void sum_cells(int columns, Sums* cells) {
    const float* const sums = row(3);
    for (int cell = 0; cell < columns; ++cell) {
      const int begin = cell * alignment_cell, end = std::min(begin + alignment_cell, width_);
      std::array<double, alignment_sum_count> of_cell{};
      for (std::size_t k = 0; k < alignment_sum_count; ++k) {
        for (int u = begin; u < end; ++u) of_cell[k] += double{sums[k * pitch_ + static_cast<std::size_t>(u)]};
      }
      const auto& [n, t, g, r, tt, tg, tr, gg, gr, rr] = of_cell;
      cells[cell] = {n, t, g, r, tt, tg, tr, gg, gr, rr};
    }
  }

 private:
  float* row(std::size_t k) { return memory_ + k * pitch_ + sample_guard; }

  float* memory_;
  int width_;
  std::size_t pitch_;
};

/// Sums over the rows up to `radius` from row j.
void sum_rows(const CellMap<Sums>& cells, int j, int radius, Sums* sums) {
  std::fill_n(sums, cells.columns, Sums{});
  for (int y = std::max(0, j - radius); y <= std::min(cells.rows - 1, j + radius); ++y) {
    const Sums* const row = cells.row(y);
    for (int i = 0; i < cells.columns; ++i) sums[i].add(row[i]);
  }
}

/// Sums over the columns up to `radius` from column i.
Sums sum_columns(const Sums* sums, int columns, int i, int radius) {
  Sums window{};
  for (int x = std::max(0, i - radius); x <= std::min(columns - 1, i + radius); ++x) window.add(sums[x]);
  return window;
}

/// Adds `scale` times the shifts, interpolated between the cells, to row v. `line`: room for a row of cells.
void add_shifts(const CellMap<float>& shifts, float scale, int v, const float* disparity, int width, float* line,
                float* aligned) {
  const CellPlace row = cell_place(v, shifts.rows);
  const float *const above = shifts.row(row.first), *const below = shifts.row(row.second);
  for (int i = 0; i < shifts.columns; ++i) line[i] = above[i] + row.share * (below[i] - above[i]);
  for (int u = 0; u < width; ++u) {
    const CellPlace column = cell_place(u, shifts.columns);
    const float first = line[column.first], second = line[column.second];
    aligned[u] = disparity[u] + scale * (first + column.share * (second - first));
  }
}

}  // namespace

void LucasKanadeOptions::validate() const {
  require_range("lucas_kanade", "radius", radius, 0, 8);
  require_range("lucas_kanade", "bias_sigma_px", bias_sigma_px, 0.001, 10.0);
  require_range("lucas_kanade", "max_shift_px", max_shift_px, 0.01, 2.0);
}

void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned) {
  options.validate();
  const int width = disparity.width(), height = disparity.height();
  for (const ImageView<const std::int16_t>& image : {pair.reference, pair.target}) {
    if (image.width() == width && image.height() == height) continue;
    fail("the disparity map has ", width, "×", height, " pixels and an image ", image.width(), "×", image.height(),
         "; they must be equal");
  }
  constexpr int rows_per_band = 8;  // of cells
  const auto workers = static_cast<std::size_t>(resolve_threads(threads));
  const std::size_t row_numbers = WorkerRows::count * WorkerRows::pitch(width);
  auto memory = scratch_vector<float>(row_numbers * workers);
  CellMap<Sums> cells(width, height);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    WorkerRows rows(memory.data() + row_numbers * static_cast<std::size_t>(worker), width);
    for (int j = first; j < last; ++j) {
      rows.clear_sums();
      const int end = std::min((j + 1) * alignment_cell, height);
      for (int v = j * alignment_cell; v < end; ++v) rows.add(pair, disparity, v);
      rows.sum_cells(cells.columns, cells.row(j));
    }
  });
  CellMap<float> shifts(width, height);
  const AlignmentSettings settings = alignment_settings(options);
  const auto columns = static_cast<std::size_t>(cells.columns);
  auto row_sums = scratch_vector<Sums>(columns * workers);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    Sums* const sums = row_sums.data() + columns * static_cast<std::size_t>(worker);
    for (int j = first; j < last; ++j) {
      sum_rows(cells, j, options.radius, sums);
      for (int i = 0; i < cells.columns; ++i) {
        shifts.row(j)[i] = alignment_shift(sum_columns(sums, cells.columns, i, options.radius), settings);
      }
    }
  });
  aligned.resize(width, height);
  const float scale = 1 - shift_line(pair.shift, 0).slope;  // d disparity / d residual
  parallel_rows(height, rows_per_band * alignment_cell, threads, [&](int first, int last, int worker) {
    float* const line = memory.data() + columns * static_cast<std::size_t>(worker);
    for (int v = first; v < last; ++v) add_shifts(shifts, scale, v, disparity.row(v), width, line, aligned.row(v));
  });
}

}  // namespace roadstereo

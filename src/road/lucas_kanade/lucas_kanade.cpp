#include "roadstereo/lucas_kanade.hpp"

#include <algorithm>
#include <cstddef>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/scratch.hpp"
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

/// Leaves the ends of the row as they are: no sample is there.
void prefilter(const std::int16_t* row, int width, float* filtered) {
  for (int u = prefilter_radius; u < width - prefilter_radius; ++u) filtered[u] = prefiltered(row, u);
}

/// Adds the samples of row v to the sums of its cells. `rows`: room for two rows.
void add_row(const TransformedPair& pair, ImageView<const float> disparity, int v, float* rows, Sums* cells) {
  const int width = disparity.width();
  float *const reference = rows, *const target = rows + width;
  prefilter(pair.reference.row(v), width, reference);
  prefilter(pair.target.row(v), width, target);
  const int first = pair.first_column != nullptr ? pair.first_column[v] : 0;
  const RowLine road = shift_line(pair.shift, v);
  const float* const row = disparity.row(v);
  for (int begin = 0, cell = 0; begin < width; begin += alignment_cell, ++cell) {
    const int end = std::min(begin + alignment_cell, width);
    AlignmentSums<float> sums{};
    for (int u = begin; u < end; ++u) {
      sums.add(alignment_sample(reference, target, first, width, u, without_shift(row[u], road, u)));
    }
    cells[cell].add(sums);
  }
}

/// Sums over the window of `radius` cells around a cell.
Sums window_sums(const CellMap<Sums>& cells, int i, int j, int radius) {
  Sums sums{};
  for (int y = std::max(0, j - radius); y <= std::min(cells.rows - 1, j + radius); ++y) {
    const Sums* const row = cells.row(y);
    for (int x = std::max(0, i - radius); x <= std::min(cells.columns - 1, i + radius); ++x) sums.add(row[x]);
  }
  return sums;
}

/// Adds `scale` times the shifts, interpolated between the cells, to row v.
void add_shifts(const CellMap<float>& shifts, float scale, int v, const float* disparity, int width, float* aligned) {
  const CellPlace row = cell_place(v, shifts.rows);
  const float *const above = shifts.row(row.first), *const below = shifts.row(row.second);
  for (int u = 0; u < width; ++u) {
    const CellPlace column = cell_place(u, shifts.columns);
    const float first = above[column.first] + row.share * (below[column.first] - above[column.first]);
    const float second = above[column.second] + row.share * (below[column.second] - above[column.second]);
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
  const std::size_t row_numbers = 2 * static_cast<std::size_t>(width);
  auto rows = scratch_vector<float>(row_numbers * static_cast<std::size_t>(resolve_threads(threads)));
  CellMap<Sums> cells(width, height);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    float* const own = rows.data() + row_numbers * static_cast<std::size_t>(worker);
    const int end = std::min(last * alignment_cell, height);
    for (int v = first * alignment_cell; v < end; ++v) add_row(pair, disparity, v, own, cells.row(v / alignment_cell));
  });
  CellMap<float> shifts(width, height);
  const AlignmentSettings settings = alignment_settings(options);
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      for (int i = 0; i < cells.columns; ++i) {
        shifts.row(j)[i] = alignment_shift(window_sums(cells, i, j, options.radius), settings);
      }
    }
  });
  aligned.resize(width, height);
  const float scale = 1 - shift_line(pair.shift, 0).slope;  // d disparity / d residual
  parallel_rows(height, rows_per_band * alignment_cell, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) add_shifts(shifts, scale, v, disparity.row(v), width, aligned.row(v));
  });
}

}  // namespace roadstereo

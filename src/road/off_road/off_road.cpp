#include "roadstereo/off_road.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/off_road/cell_map.hpp"
#include "road/off_road/confirmation.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 8;  // of cells

void sum_log_sigmas(ImageView<const float> sigma, int threads, CellMap<LogSigmas>& cells) {
  parallel_rows(cells.rows, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first * alignment_cell; v < std::min(last * alignment_cell, sigma.height()); ++v) {
      const float* const errors = sigma.row(v);
      LogSigmas* const of_cell = cells.row(v / alignment_cell);
      for (int u = 0; u < sigma.width(); ++u) of_cell[u / alignment_cell].add({log_sigma(errors[u]), 1});
    }
  });
}

/// Sums of the cells up to confirmation_radius columns away; of all rows around row j.
void sum_around(const CellMap<LogSigmas>& cells, int j, LogSigmas* of_columns, LogSigmas* sums) {
  std::fill_n(of_columns, cells.columns, LogSigmas{});
  for (int y = std::max(0, j - confirmation_radius); y <= std::min(cells.rows - 1, j + confirmation_radius); ++y) {
    for (int i = 0; i < cells.columns; ++i) of_columns[i].add(cells.row(y)[i]);
  }
  for (int i = 0; i < cells.columns; ++i) {
    sums[i] = {};
    const int end = std::min(cells.columns, i + confirmation_radius + 1);
    for (int x = std::max(0, i - confirmation_radius); x < end; ++x) sums[i].add(of_columns[x]);
  }
}

void assess_cells(ImageView<const float> sigma, ImageView<const float> correlation, float log2_max_sigma, int threads,
                  CellMap<CellState>& states) {
  CellMap<LogSigmas> cells(states.columns, states.rows);
  sum_log_sigmas(sigma, threads, cells);
  const auto columns = static_cast<std::size_t>(states.columns);
  auto memory = scratch_vector<LogSigmas>(2 * columns * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(states.rows, rows_per_band, threads, [&](int first, int last, int worker) {
    LogSigmas* const of_columns = memory.data() + 2 * columns * static_cast<std::size_t>(worker);
    LogSigmas* const sums = of_columns + columns;
    for (int j = first; j < last; ++j) {
      sum_around(cells, j, of_columns, sums);
      for (int i = 0; i < states.columns; ++i) {
        states.row(j)[i] = assess_cell(sums[i], correlation(i, j), log2_max_sigma);
      }
    }
  });
}

/// Whether a cell and its eight neighbours are off the road.
bool is_inner(const CellMap<CellState>& states, int i, int j) {
  for (int y = std::max(0, j - 1); y <= std::min(states.rows - 1, j + 1); ++y) {
    for (int x = std::max(0, i - 1); x <= std::min(states.columns - 1, i + 1); ++x) {
      if (states.row(y)[x] != off_road) return false;
    }
  }
  return true;
}

}  // namespace

void OffRoadOptions::validate() const {
  require_range("off_road", "max_sigma_px", max_sigma_px, 0.0, 10.0);
}

void reject_off_road(ImageView<const float> correlation, const OffRoadOptions& options, int threads,
                     Image<float>& disparity, Image<float>& sigma) {
  options.validate();
  const int width = disparity.width(), height = disparity.height();
  const int columns = alignment_cells(width), rows = alignment_cells(height);
  require_equal_sizes(disparity, sigma);
  if (correlation.width() != columns || correlation.height() != rows) {
    fail("the correlation has ", correlation.width(), "×", correlation.height(), " cells; a map of ", width, "×",
         height, " pixels has ", columns, "×", rows);
  }
  if (options.max_sigma_px == 0) return;
  CellMap<CellState> states(columns, rows);
  assess_cells(sigma, correlation, std::log2(static_cast<float>(options.max_sigma_px)), threads, states);
  connect_with_border(states);
  reject_cells(
      columns, rows, threads, [&](int i, int j) { return is_inner(states, i, j); }, disparity, sigma);
}

}  // namespace roadstereo

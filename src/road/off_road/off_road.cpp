#include "roadstereo/off_road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/off_road/confirmation.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int cell_rows_per_band = 8;

/// One value per cell, in scratch memory.
template <class T>
struct CellMap {
  int columns, rows;
  ScratchVector<T> values;

  CellMap(int columns_of_map, int rows_of_map)
      : columns(columns_of_map),
        rows(rows_of_map),
        values(scratch_vector<T>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))) {}
  T* row(int j) { return values.data() + std::ptrdiff_t{j} * columns; }
  const T* row(int j) const { return values.data() + std::ptrdiff_t{j} * columns; }
};

/// Leaves out masked pixels.
void sum_log_sigmas(ImageView<const float> sigma, ImageView<const std::uint8_t> mask, int threads,
                    CellMap<LogSigmas>& cells) {
  parallel_rows(cells.rows, cell_rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first * alignment_cell; v < std::min(last * alignment_cell, sigma.height()); ++v) {
      const float* const errors = sigma.row(v);
      const std::uint8_t* const masked = mask.empty() ? nullptr : mask.row(v);
      LogSigmas* const of_cell = cells.row(v / alignment_cell);
      for (int u = 0; u < sigma.width(); ++u) {
        if (masked == nullptr || masked[u] == 0) of_cell[u / alignment_cell].add({log_sigma(errors[u]), 1});
      }
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

void assess_cells(const CoarseScene& scene, ImageView<const float> correlation, ImageView<const float> disparity,
                  ImageView<const float> sigma, ImageView<const std::uint8_t> mask, float log2_max_sigma, int threads,
                  CellMap<CellState>& states) {
  CellMap<LogSigmas> cells(states.columns, states.rows);
  sum_log_sigmas(sigma, mask, threads, cells);
  const auto columns = static_cast<std::size_t>(states.columns);
  auto memory = scratch_vector<LogSigmas>(2 * columns * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(states.rows, cell_rows_per_band, threads, [&](int first, int last, int worker) {
    LogSigmas* const of_columns = memory.data() + 2 * columns * static_cast<std::size_t>(worker);
    LogSigmas* const sums = of_columns + columns;
    for (int j = first; j < last; ++j) {
      sum_around(cells, j, of_columns, sums);
      std::array<RowLine, alignment_cell> lines;
      for (int y = 0; y < alignment_cell; ++y) {
        lines[static_cast<std::size_t>(y)] = shift_line(scene.shift, j * alignment_cell + y);
      }
      for (int i = 0; i < states.columns; ++i) {
        const bool confirmed = is_confirmed(sums[i], correlation(i, j), log2_max_sigma);
        states.row(j)[i] = assess_cell(scene, cell_residual(disparity, lines.data(), i, j), confirmed, i, j);
      }
    }
  });
}

/// Flood fill from the upper, left and right border through cells that are not on the road and their eight neighbours.
void mark_outside(CellMap<CellState>& states) {
  auto front = scratch_vector<int>();
  front.reserve(states.values.size());
  const auto visit = [&](int i, int j) {
    CellState& state = states.row(j)[i];
    if (state == on_road || state >= outside) return;
    state = static_cast<CellState>(state + outside);
    front.push_back(j * states.columns + i);
  };
  for (int i = 0; i < states.columns; ++i) visit(i, 0);
  for (int j = 0; j < states.rows; ++j) {
    visit(0, j);
    visit(states.columns - 1, j);
  }
  while (!front.empty()) {
    const int i = front.back() % states.columns, j = front.back() / states.columns;
    front.pop_back();
    for (int y = std::max(0, j - 1); y <= std::min(states.rows - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(states.columns - 1, i + 1); ++x) visit(x, y);
    }
  }
}

void reject_cells(const CellMap<CellState>& states, int threads, Image<float>& disparity, Image<float>& sigma) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const ImageView<const CellState> view(states.values.data(), states.columns, states.rows);
  parallel_rows(states.rows, cell_rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const int end_v = std::min((j + 1) * alignment_cell, disparity.height());
      for (int i = 0; i < states.columns; ++i) {
        if (!is_rejected(view, i, j)) continue;
        const int u = i * alignment_cell, count = std::min(alignment_cell, disparity.width() - u);
        for (int v = j * alignment_cell; v < end_v; ++v) {
          std::fill_n(disparity.row(v) + u, count, nan);
          std::fill_n(sigma.row(v) + u, count, nan);
        }
      }
    }
  });
}

void require_sizes(ImageView<const float> correlation, const DisparityPriorView& scene,
                   ImageView<const float> disparity, ImageView<const float> sigma) {
  const int width = disparity.width(), height = disparity.height();
  const int columns = alignment_cells(width), rows = alignment_cells(height);
  if (sigma.width() != width || sigma.height() != height) {
    fail("the disparity map has ", width, "×", height, " pixels and its standard errors ", sigma.width(), "×",
         sigma.height(), "; they must be equal");
  }
  if (correlation.width() != columns || correlation.height() != rows) {
    fail("the correlation has ", correlation.width(), "×", correlation.height(), " cells; a map of ", width, "×",
         height, " pixels has ", columns, "×", rows);
  }
  if (scene.factor < alignment_cell || scene.disparity.width() != width / scene.factor ||
      scene.disparity.height() != height / scene.factor) {
    fail("the map of the scene has ", scene.disparity.width(), "×", scene.disparity.height(), " pixels of ",
         scene.factor, "×", scene.factor, "; a map of ", width, "×", height, " pixels needs ⌊W/s⌋×⌊H/s⌋ of s×s, s ≥ ",
         alignment_cell);
  }
}

}  // namespace

void OffRoadOptions::validate() const {
  require_range("off_road", "max_sigma_px", max_sigma_px, 0.0, 10.0);
}

void reject_off_road(ImageView<const float> correlation, const DisparityPriorView& scene, const PerspectiveShift& shift,
                     ImageView<const std::uint8_t> mask, const OffRoadOptions& options, int threads,
                     Image<float>& disparity, Image<float>& sigma) {
  options.validate();
  require_sizes(correlation, scene, disparity, sigma);
  require_mask_size({mask.width(), mask.height()}, {disparity.width(), disparity.height()});
  if (options.max_sigma_px == 0) return;
  CellMap<CellState> states(correlation.width(), correlation.height());
  assess_cells({scene.disparity, scene.factor, shift}, correlation, disparity, sigma, mask,
               std::log2(static_cast<float>(options.max_sigma_px)), threads, states);
  mark_outside(states);
  reject_cells(states, threads, disparity, sigma);
}

}  // namespace roadstereo

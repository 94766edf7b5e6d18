#include "roadstereo/off_road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/off_road/column_sums.hpp"
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

/// Sums of cells, and of the columns of pixels of a row of them for each worker.
class CellSums {
 public:
  CellSums(int columns, int rows, int width, int threads)
      : sigmas(columns, rows),
        residuals(columns, rows),
        width_(static_cast<std::size_t>(width)),
        numbers_(scratch_vector<std::int32_t>(3 * width_ * static_cast<std::size_t>(resolve_threads(threads)))),
        sums_(scratch_vector<float>(width_ * static_cast<std::size_t>(resolve_threads(threads)))) {}

  /// Of row j of cells: of standard errors that are not masked, and of disparities.
  void fill(ImageView<const float> disparity, ImageView<const float> sigma, ImageView<const std::uint8_t> mask,
            const PerspectiveShift& shift, int j, int worker) {
    const auto at = static_cast<std::size_t>(worker);
    std::int32_t* const numbers = numbers_.data() + 3 * width_ * at;
    const ColumnSums of_columns{numbers, numbers + width_, sums_.data() + width_ * at, numbers + 2 * width_};
    std::fill_n(numbers, 3 * width_, 0);
    std::fill_n(of_columns.residuals, width_, 0.0F);
    for (int v = j * alignment_cell; v < std::min((j + 1) * alignment_cell, disparity.height()); ++v) {
      add_row({sigma.row(v), mask.empty() ? nullptr : mask.row(v), disparity.row(v), shift_line(shift, v),
               disparity.width()},
              of_columns);
    }
    for (int i = 0; i < sigmas.columns; ++i) {
      LogSigmas& of_cell = sigmas.row(j)[i] = {};
      ResidualSum& residual = residuals.row(j)[i] = {};
      for (int u = i * alignment_cell; u < std::min((i + 1) * alignment_cell, disparity.width()); ++u) {
        of_cell.add({of_columns.log_sigmas[u], of_columns.sigmas[u]});
        residual.add({of_columns.residuals[u], of_columns.known[u]});
      }
    }
  }

  CellMap<LogSigmas> sigmas;
  CellMap<ResidualSum> residuals;

 private:
  std::size_t width_;
  ScratchVector<std::int32_t> numbers_;
  ScratchVector<float> sums_;
};

/// Running sums of the cells up to confirmation_radius columns away; of all rows around row j.
class SumsAround {
 public:
  /// `of_columns`: scratch memory, one a column of cells. Row `first` comes first.
  SumsAround(const CellMap<LogSigmas>& cells, int first, LogSigmas* of_columns)
      : cells_(cells), of_columns_(of_columns) {
    std::fill_n(of_columns_, cells_.columns, LogSigmas{});
    for (int y = first - confirmation_radius; y < first + confirmation_radius; ++y) {
      add_row(y, &LogSigmas::add);
    }
  }

  /// Calls `visit(i, sums)` for the cells of row j, that after the last one.
  template <class Visit>
  void next_row(int j, const Visit& visit) {
    add_row(j + confirmation_radius, &LogSigmas::add);
    LogSigmas sums;
    for (int i = 0; i < std::min(confirmation_radius, cells_.columns); ++i) sums.add(of_columns_[i]);
    for (int i = 0; i < cells_.columns; ++i) {
      if (i + confirmation_radius < cells_.columns) sums.add(of_columns_[i + confirmation_radius]);
      visit(i, sums);
      if (i >= confirmation_radius) sums.subtract(of_columns_[i - confirmation_radius]);
    }
    add_row(j - confirmation_radius, &LogSigmas::subtract);
  }

 private:
  void add_row(int y, void (LogSigmas::*change)(const LogSigmas&)) {
    if (y < 0 || y >= cells_.rows) return;
    for (int i = 0; i < cells_.columns; ++i) (of_columns_[i].*change)(cells_.row(y)[i]);
  }

  const CellMap<LogSigmas>& cells_;
  LogSigmas* of_columns_;
};

void assess_cells(const CoarseScene& scene, ImageView<const float> correlation, ImageView<const float> disparity,
                  ImageView<const float> sigma, ImageView<const std::uint8_t> mask, float log2_max_sigma, int threads,
                  CellMap<CellState>& states) {
  CellSums sums(states.columns, states.rows, disparity.width(), threads);
  parallel_rows(states.rows, cell_rows_per_band, threads, [&](int first, int last, int worker) {
    for (int j = first; j < last; ++j) sums.fill(disparity, sigma, mask, scene.shift, j, worker);
  });
  const auto columns = static_cast<std::size_t>(states.columns);
  auto memory = scratch_vector<LogSigmas>(columns * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(states.rows, cell_rows_per_band, threads, [&](int first, int last, int worker) {
    SumsAround around(sums.sigmas, first, memory.data() + columns * static_cast<std::size_t>(worker));
    for (int j = first; j < last; ++j) {
      around.next_row(j, [&](int i, const LogSigmas& of_surroundings) {
        const int cell_width = std::min(alignment_cell, disparity.width() - i * alignment_cell);
        const int cell_height = std::min(alignment_cell, disparity.height() - j * alignment_cell);
        const bool confirmed = is_confirmed(of_surroundings, correlation(i, j), log2_max_sigma);
        states.row(j)[i] = sums.sigmas.row(j)[i].count < cell_width * cell_height
                               ? masked
                               : assess_cell(scene, sums.residuals.row(j)[i].mean(), confirmed, i, j);
      });
    }
  });
}

/// Columns first … last of cells of which some are not masked: what lies beside a black border begins there.
struct ColumnRange {
  int first, last;
};

ColumnRange unmasked_columns(const CellMap<CellState>& states) {
  const auto is_masked = [&](int i) {
    for (int j = 0; j < states.rows; ++j) {
      if (states.row(j)[i] != masked) return false;
    }
    return true;
  };
  ColumnRange range{0, states.columns - 1};
  while (range.first < range.last && is_masked(range.first)) ++range.first;
  while (range.last > range.first && is_masked(range.last)) --range.last;
  return range;
}

/// Flood fill from the upper, left and right border, or from masked cells there, through cells that are not on the road
/// and their eight neighbours. It does not go along masked cells, such as those of a bonnet.
void mark_outside(CellMap<CellState>& states) {
  auto front = scratch_vector<int>();
  front.reserve(states.values.size());
  const auto visit = [&](int i, int j) {
    CellState& state = states.row(j)[i];
    if (state == on_road || state >= outside) return;
    state = static_cast<CellState>(state + outside);
    front.push_back(j * states.columns + i);
  };
  const auto [left, right] = unmasked_columns(states);
  for (int i = left; i <= right; ++i) {
    int j = 0;
    while (j + 1 < states.rows && states.row(j)[i] == masked) ++j;
    visit(i, j);
  }
  for (int j = 0; j < states.rows; ++j) {
    visit(left, j);
    visit(right, j);
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
  require_same_size("the disparity map", map_size(disparity), "its standard errors", map_size(sigma));
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

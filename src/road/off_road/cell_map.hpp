#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/off_road/confirmation.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// One value per cell, in scratch memory.
template <class T>
struct CellMap {
  int columns, rows;
  ScratchVector<T> values;

  CellMap(int columns_of_map, int rows_of_map)
      : columns(columns_of_map),
        rows(rows_of_map),
        values(scratch_vector<T>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))) {}
  T& operator()(int i, int j) { return row(j)[i]; }
  const T& operator()(int i, int j) const { return row(j)[i]; }
  T* row(int j) { return values.data() + std::ptrdiff_t{j} * columns; }
  const T* row(int j) const { return values.data() + std::ptrdiff_t{j} * columns; }
};

/// Flood fill from the upper, left and right border through unconfirmed cells and their eight neighbours.
void connect_with_border(CellMap<CellState>& states);

/// Throws Error when a map and its standard errors differ in size.
void require_equal_sizes(ImageView<const float> disparity, ImageView<const float> sigma);

/// Makes the pixels of the cells (i, j) invalid for which `is_rejected(i, j)`.
template <class Predicate>
void reject_cells(int columns, int rows, int threads, const Predicate& is_rejected, Image<float>& disparity,
                  Image<float>& sigma) {
  constexpr int rows_per_band = 8;  // of cells
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  parallel_rows(rows, rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      const int end_v = std::min((j + 1) * alignment_cell, disparity.height());
      for (int i = 0; i < columns; ++i) {
        if (!is_rejected(i, j)) continue;
        const int u = i * alignment_cell, count = std::min(alignment_cell, disparity.width() - u);
        for (int v = j * alignment_cell; v < end_v; ++v) {
          std::fill_n(disparity.row(v) + u, count, nan);
          std::fill_n(sigma.row(v) + u, count, nan);
        }
      }
    }
  });
}

}  // namespace roadstereo

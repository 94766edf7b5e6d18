#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "damage/cell_box.hpp"

namespace roadstereo {

/// Run of consecutive cells of a row, `first` … `last`.
struct CellRun {
  int row = 0, first = 0, last = 0;
};

/// One connected component of a mask, as runs.
struct ConnectedComponent {
  std::span<const CellRun> runs;  ///< by row, then by column
  std::size_t size = 0;           ///< cells
  CellBox box;
  bool touches_border = false;
};

/// Connected-component labelling of a mask with 4-connectivity, by run-length encoding and union–find. Components are
/// in the order of their first cells, row by row.
class ConnectedComponents {
 public:
  /// Which cells form components.
  enum class Foreground { nonzero, zero };
  explicit ConnectedComponents(const Image<std::uint8_t>& mask, Foreground foreground = Foreground::nonzero);
  ConnectedComponents(ConnectedComponents&&) = default;
  ConnectedComponents& operator=(ConnectedComponents&&) = default;

  std::size_t size() const { return components_.size(); }
  auto begin() const { return components_.begin(); }
  auto end() const { return components_.end(); }

 private:
  std::vector<CellRun> runs_;  ///< component by component
  std::vector<ConnectedComponent> components_;
};

/// First cell of a row from `i` on that is not 0; `width` if there is none.
int next_nonzero(const std::uint8_t* row, int i, int width);

/// Call `visit(column, row)` for the 4-neighbours of the runs of a component that lie in an image of columns×rows
/// cells: all that surround it, and cells of its own.
template <class Visit>
void for_each_neighbour(const ConnectedComponent& component, int columns, int rows, const Visit& visit) {
  for (const CellRun& run : component.runs) {
    if (run.first > 0) visit(run.first - 1, run.row);
    if (run.last + 1 < columns) visit(run.last + 1, run.row);
    for (int i = run.first; i <= run.last; ++i) {
      if (run.row > 0) visit(i, run.row - 1);
      if (run.row + 1 < rows) visit(i, run.row + 1);
    }
  }
}

/// Set the cells of a component to a value.
void fill_component(const ConnectedComponent& component, std::uint8_t value, Image<std::uint8_t>& mask);

/// Set the holes of a mask to 255: components of zeros with at most `max_cells` that do not touch the border.
void fill_holes(Image<std::uint8_t>& mask, std::size_t max_cells);

}  // namespace roadstereo

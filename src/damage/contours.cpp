#include "damage/contours.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

float slope_at(const Image<float>& depth, int i, int j) {
  const int left = std::max(0, i - 1);
  const int right = std::min(depth.width() - 1, i + 1);
  const int above = std::max(0, j - 1);
  const int below = std::min(depth.height() - 1, j + 1);
  const float along = (depth(right, j) - depth(left, j)) / static_cast<float>(std::max(1, right - left));
  const float down = (depth(i, below) - depth(i, above)) / static_cast<float>(std::max(1, below - above));
  return std::hypot(along, down);
}

/// Sums along a contour, and the cells inside.
struct ContourSums {
  double slopes = 0;
  int cells = 0;
  double area = 0;

  Contour contour() const { return {cells == 0 ? 0 : slopes / cells, area}; }
};

/// How deep the flood from the seeds has sunk when it reaches each cell of a box: the number of levels that it covers.
/// As the flood of a level holds those of all higher ones, one sinking flood makes them all.
class SinkingFlood {
 public:
  SinkingFlood(const DepthField& field, const ConnectedRegion& seeds, const std::array<float, contour_levels>& levels,
               const Box& within)
      : field_(field), levels_(levels), box_(within), covered_(within.columns(), within.rows(), 0) {
    for (const CellRun& run : seeds.runs) {
      for (int i = run.first; i <= run.last; ++i) reach(i, run.row, contour_levels);
    }
    for (int k = contour_levels; k > 0; --k) spread(k);
  }

  /// Number of the levels, from the lowest on, whose flood holds the cell.
  int covered(int i, int j) const {
    return box_.contains(i, j) ? covered_(i - box_.first_column, j - box_.first_row) : 0;
  }

 private:
  void reach(int i, int j, int level) {
    if (!box_.contains(i, j)) return;
    std::uint8_t& cell = covered_(i - box_.first_column, j - box_.first_row);
    if (cell != 0 || field_.allowed(i, j) == 0) return;
    const auto above = std::lower_bound(levels_.begin(), levels_.end(), field_.depth(i, j));
    const int own = std::min(level, static_cast<int>(above - levels_.begin()));
    if (own == 0) return;
    cell = static_cast<std::uint8_t>(own);
    open_[static_cast<std::size_t>(own - 1)].push_back({i, j});
  }

  /// Over all cells that the flood of level `k` reaches and that of the next higher did not.
  void spread(int k) {
    std::vector<CellIndex>& open = open_[static_cast<std::size_t>(k - 1)];
    while (!open.empty()) {
      const CellIndex cell = open.back();
      open.pop_back();
      for_neighbours(cell.column, cell.row, field_.depth.width(), field_.depth.height(),
                     [&](int i, int j) { reach(i, j, k); });
    }
  }

  const DepthField& field_;
  const std::array<float, contour_levels>& levels_;
  Box box_;
  Image<std::uint8_t> covered_;
  std::array<std::vector<CellIndex>, contour_levels> open_;  ///< cells whose neighbours are still to be reached
};

}  // namespace

bool on_contour(const BoxMask& region, int i, int j, int columns, int rows) {
  return (i > 0 && !region(i - 1, j)) || (i + 1 < columns && !region(i + 1, j)) || (j > 0 && !region(i, j - 1)) ||
         (j + 1 < rows && !region(i, j + 1));
}

std::vector<CellIndex> contour_cells(const BoxMask& region, int columns, int rows) {
  std::vector<CellIndex> cells;
  const Box& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (region(i, j) && on_contour(region, i, j, columns, rows)) cells.push_back({i, j});
    }
  }
  return cells;
}

Contour contour_of(const DepthField& field, const BoxMask& region) {
  ContourSums sums;
  const Box& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!region(i, j)) continue;
      ++sums.area;
      if (!on_contour(region, i, j, field.depth.width(), field.depth.height())) continue;
      sums.slopes += slope_at(field.depth, i, j);
      ++sums.cells;
    }
  }
  return sums.contour();
}

std::array<Contour, contour_levels> contours_around(const DepthField& field, const ConnectedRegion& seeds,
                                                    const std::array<float, contour_levels>& levels,
                                                    const Box& within) {
  const SinkingFlood flood(field, seeds, levels, within);
  std::array<ContourSums, contour_levels> sums{};
  for (int j = within.first_row; j <= within.last_row; ++j) {
    for (int i = within.first_column; i <= within.last_column; ++i) {
      const int covered = flood.covered(i, j);
      if (covered == 0) continue;
      for (int k = 0; k < covered; ++k) ++sums[static_cast<std::size_t>(k)].area;
      // On the contour of those levels that a neighbour is not in.
      int least = covered;
      for_neighbours(i, j, field.depth.width(), field.depth.height(),
                     [&](int column, int row) { least = std::min(least, flood.covered(column, row)); });
      if (least == covered) continue;
      const double slope = slope_at(field.depth, i, j);
      for (int k = least; k < covered; ++k) {
        sums[static_cast<std::size_t>(k)].slopes += slope;
        ++sums[static_cast<std::size_t>(k)].cells;
      }
    }
  }
  std::array<Contour, contour_levels> contours;
  std::transform(sums.begin(), sums.end(), contours.begin(), [](const ContourSums& sum) { return sum.contour(); });
  return contours;
}

}  // namespace roadstereo

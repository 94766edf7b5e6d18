#include "damage/contours.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

/// Sums over the cells of a contour and of its region.
struct ContourSums {
  double slopes = 0;
  int cells = 0;
  double area = 0;

  ContourStatistics statistics() const { return {cells == 0 ? 0 : slopes / cells, area}; }
};

/// Branch of the component tree: for each cell of a box the number of levels whose component, the one that contains the
/// seeds, contains the cell. Components of lower levels contain those of higher levels, so a flood that descends from
/// the highest level to the lowest visits each cell once.
class ComponentBranch {
 public:
  ComponentBranch(const DepthField& field, const ConnectedComponent& seeds,
                  const std::array<float, contour_level_count>& levels, const CellBox& within)
      : field_(field), levels_(levels), box_(within), level_counts_(within.columns(), within.rows(), 0) {
    for (const CellRun& run : seeds.runs) {
      for (int i = run.first; i <= run.last; ++i) visit(i, run.row, contour_level_count);
    }
    for (int k = contour_level_count; k > 0; --k) flood_level(k);
  }

  /// Numbers of levels of row j of the box.
  const std::uint8_t* level_counts(int j) const { return level_counts_.row(j - box_.first_row); }
  /// Number of levels, from the lowest, whose component contains the cell; 0 outside the box.
  int level_count(int i, int j) const {
    return box_.contains(i, j) ? level_counts_(i - box_.first_column, j - box_.first_row) : 0;
  }

 private:
  /// Add the cell to the lowest `level_count` components, as far as its depth exceeds their levels.
  void visit(int i, int j, int level_count) {
    if (!box_.contains(i, j)) return;
    std::uint8_t& cell = level_counts_(i - box_.first_column, j - box_.first_row);
    if (cell != 0 || field_.allowed(i, j) == 0) return;
    const auto above = std::lower_bound(levels_.begin(), levels_.end(), field_.depth(i, j));
    const int own = std::min(level_count, static_cast<int>(above - levels_.begin()));
    if (own == 0) return;
    cell = static_cast<std::uint8_t>(own);
    front_[static_cast<std::size_t>(own - 1)].push_back({i, j});
  }

  /// Visit the cells that belong to the component of level `k` but not to that of the next higher level.
  void flood_level(int k) {
    std::vector<CellIndex>& front = front_[static_cast<std::size_t>(k - 1)];
    while (!front.empty()) {
      const CellIndex cell = front.back();
      front.pop_back();
      for_each_neighbour(cell.column, cell.row, field_.depth.width(), field_.depth.height(),
                         [&](int i, int j) { visit(i, j, k); });
    }
  }

  const DepthField& field_;
  const std::array<float, contour_level_count>& levels_;
  CellBox box_;
  Image<std::uint8_t> level_counts_;
  std::array<std::vector<CellIndex>, contour_level_count> front_;  ///< by level: cells with unvisited neighbours
};

}  // namespace

bool is_on_contour(const BoxMask& region, int i, int j, int columns, int rows) {
  return (i > 0 && !region(i - 1, j)) || (i + 1 < columns && !region(i + 1, j)) || (j > 0 && !region(i, j - 1)) ||
         (j + 1 < rows && !region(i, j + 1));
}

std::vector<CellIndex> contour_cells(const BoxMask& region, int columns, int rows) {
  std::vector<CellIndex> cells;
  const CellBox& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (region(i, j) && is_on_contour(region, i, j, columns, rows)) cells.push_back({i, j});
    }
  }
  return cells;
}

float slope_at(const Image<float>& depth, int i, int j) {
  const int left = std::max(0, i - 1);
  const int right = std::min(depth.width() - 1, i + 1);
  const int above = std::max(0, j - 1);
  const int below = std::min(depth.height() - 1, j + 1);
  const float along = (depth(right, j) - depth(left, j)) / static_cast<float>(std::max(1, right - left));
  const float down = (depth(i, below) - depth(i, above)) / static_cast<float>(std::max(1, below - above));
  return std::sqrt(along * along + down * down);
}

ContourStatistics measure_contour(const DepthField& field, const BoxMask& region) {
  ContourSums sums;
  const CellBox& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (!region(i, j)) continue;
      ++sums.area;
      if (!is_on_contour(region, i, j, field.depth.width(), field.depth.height())) continue;
      sums.slopes += slope_at(field.depth, i, j);
      ++sums.cells;
    }
  }
  return sums.statistics();
}

std::array<ContourStatistics, contour_level_count> measure_contours(
    const DepthField& field, const ConnectedComponent& seeds, const std::array<float, contour_level_count>& levels,
    const CellBox& within) {
  const ComponentBranch branch(field, seeds, levels, within);
  std::array<ContourSums, contour_level_count> sums{};
  for (int j = within.first_row; j <= within.last_row; ++j) {
    const std::uint8_t* const counts = branch.level_counts(j);
    for (int i = within.first_column; i <= within.last_column; ++i) {
      const int count = counts[i - within.first_column];
      if (count == 0) continue;
      ++sums[static_cast<std::size_t>(count - 1)].area;
      // The cell is on the contour of every component that does not contain all of its neighbours.
      int min_count = count;
      for_each_neighbour(i, j, field.depth.width(), field.depth.height(), [&](int column, int row) {
        min_count = std::min(min_count, branch.level_count(column, row));
      });
      if (min_count == count) continue;
      const double slope = slope_at(field.depth, i, j);
      for (int k = min_count; k < count; ++k) {
        sums[static_cast<std::size_t>(k)].slopes += slope;
        ++sums[static_cast<std::size_t>(k)].cells;
      }
    }
  }
  // So far the area of each level is what it adds to that of the next higher one.
  for (std::size_t k = contour_level_count - 1; k > 0; --k) sums[k - 1].area += sums[k].area;
  std::array<ContourStatistics, contour_level_count> contours;
  std::transform(sums.begin(), sums.end(), contours.begin(), [](const ContourSums& sum) { return sum.statistics(); });
  return contours;
}

}  // namespace roadstereo

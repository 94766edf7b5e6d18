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

/// Mask of a region with a margin of one cell, which is outside the region.
class PaddedMask {
 public:
  explicit PaddedMask(const BoxMask& region) : box_(region.box()), cells_(box_.columns() + 2, box_.rows() + 2, 0) {
    for (int j = 0; j < box_.rows(); ++j) std::copy_n(region.cells().row(j), box_.columns(), cells_.row(j + 1) + 1);
  }
  /// What lies beside an image of columns×rows cells becomes part of the region.
  void fill_beside(int columns, int rows) {
    const int last = box_.columns() + 1, bottom = box_.rows() + 1;
    for (int j = 0; j <= bottom; ++j) {
      if (box_.first_column == 0) cells_(0, j) = 255;
      if (box_.last_column + 1 == columns) cells_(last, j) = 255;
    }
    if (box_.first_row == 0) std::fill_n(cells_.row(0), last + 1, std::uint8_t{255});
    if (box_.last_row + 1 == rows) std::fill_n(cells_.row(bottom), last + 1, std::uint8_t{255});
  }
  /// Cells of the region with a 4-neighbour outside it, row by row.
  std::vector<CellIndex> rim() const {
    const int columns = box_.columns();
    std::vector<std::uint8_t> on_rim(static_cast<std::size_t>(columns));
    std::vector<CellIndex> cells;
    for (int j = 0; j < box_.rows(); ++j) {
      const std::uint8_t *const above = cells_.row(j) + 1, *const below = cells_.row(j + 2) + 1;
      find_rim(above, cells_.row(j + 1) + 1, below, columns, on_rim.data());
      for (int i = next_nonzero(on_rim.data(), 0, columns); i < columns;
           i = next_nonzero(on_rim.data(), i + 1, columns)) {
        cells.push_back({box_.first_column + i, box_.first_row + j});
      }
    }
    return cells;
  }

 private:
  /// A function of its own, whose result no row can alias: it becomes vectors.
  static void find_rim(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, int count,
                       std::uint8_t* on_rim) {
    for (int i = 0; i < count; ++i) on_rim[i] = here[i] & ~(above[i] & below[i] & here[i - 1] & here[i + 1]);
  }

  CellBox box_;
  Image<std::uint8_t> cells_;
};

}  // namespace

std::vector<CellIndex> rim_cells(const BoxMask& region) {
  return PaddedMask(region).rim();
}

std::vector<CellIndex> contour_cells(const BoxMask& region, int columns, int rows) {
  PaddedMask mask(region);
  mask.fill_beside(columns, rows);
  return mask.rim();
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
  sums.area = static_cast<double>(cell_count(region));
  for (const CellIndex cell : contour_cells(region, field.depth.width(), field.depth.height())) {
    sums.slopes += slope_at(field.depth, cell.column, cell.row);
    ++sums.cells;
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

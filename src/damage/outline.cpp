#include "damage/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/median.hpp"
#include "damage/contours.hpp"
#include "damage/grow.hpp"
#include "damage/neighbours.hpp"

namespace roadstereo {
namespace {

/// Mean slope along the contour against that of a cone of its opening and of depth `floor`.
double steepness_of(const Contour& contour, float floor) {
  return contour.slope * std::sqrt(contour.area / std::numbers::pi) / floor;
}

/// As far around the seeds as a contour is looked for.
Box box_around(const DepthField& field, const ConnectedRegion& seeds) {
  const int size = std::max(seeds.box.columns(), seeds.box.rows());
  return seeds.box.grown(size + 16, field.depth.width(), field.depth.height());
}

/// Median depth of the cells between two distances from a region; 0 where none is known.
float median_around(const DepthField& field, const BoxMask& region, int near, int far) {
  const Box around = region.box().grown(far, field.depth.width(), field.depth.height());
  const BoxMask inner = grow(region, near, around);
  const BoxMask outer = grow(region, far, around);
  std::vector<float> depths;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      if (outer(i, j) && !inner(i, j) && field.allowed(i, j) != 0) depths.push_back(field.depth(i, j));
    }
  }
  return depths.empty() ? 0 : take_median(depths);
}

/// Adds the neighbours that are deeper than `lowest`, `steps` times.
void grow_over(const DepthField& field, float lowest, int steps, BoxMask& region) {
  const int columns = field.depth.width();
  const int rows = field.depth.height();
  std::vector<CellIndex> rim = contour_cells(region, columns, rows);
  region = region.within(region.box().grown(steps, columns, rows));
  std::vector<CellIndex> next;
  for (int k = 0; k < steps && !rim.empty(); ++k) {
    next.clear();
    for (const CellIndex cell : rim) {
      for_neighbours(cell.column, cell.row, columns, rows, [&](int i, int j) {
        if (region(i, j) || field.allowed(i, j) == 0 || field.depth(i, j) <= lowest) return;
        region.set(i, j);
        next.push_back({i, j});
      });
    }
    rim.swap(next);
  }
}

}  // namespace

float floor_depth(const DepthField& field, const ConnectedRegion& seeds) {
  std::vector<float> depths;
  depths.reserve(seeds.size);
  for (const CellRun& run : seeds.runs) {
    const float* const row = field.depth.row(run.row);
    depths.insert(depths.end(), row + run.first, row + run.last + 1);
  }
  const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 3 / 4);
  std::nth_element(depths.begin(), at, depths.end());
  return *at;
}

BoxMask flood(const DepthField& field, const ConnectedRegion& seeds, float level) {
  const int columns = field.depth.width();
  const int rows = field.depth.height();
  Box box;
  std::vector<CellIndex> cells;
  const auto take = [&](int i, int j) {
    if (field.reached(i, j) != 0 || field.allowed(i, j) == 0 || field.depth(i, j) <= level) return;
    field.reached(i, j) = 255;
    box.add(i, j);
    cells.push_back({i, j});
  };
  for (const CellRun& run : seeds.runs) {
    for (int i = run.first; i <= run.last; ++i) take(i, run.row);
  }
  std::size_t next = 0;
  while (next < cells.size()) {
    const CellIndex cell = cells[next++];
    for_neighbours(cell.column, cell.row, columns, rows, take);
  }
  BoxMask region(box);
  for (const CellIndex& cell : cells) {
    region.set(cell.column, cell.row);
    field.reached(cell.column, cell.row) = 0;
  }
  return region;
}

Outline find_outline(const DepthField& field, const ConnectedRegion& seeds, float floor, float lowest, bool metric) {
  constexpr double cones = 3;            // a paraboloid's rim is twice as steep as the cone
  constexpr double share_of_best = 0.9;  // where nothing is that steep
  constexpr float highest_share = 0.9F;
  constexpr float halfway = 0.6F;
  const float highest = std::max(lowest, highest_share * floor);
  std::array<float, contour_levels> level{};
  for (std::size_t k = 0; k < contour_levels; ++k) {
    level[k] = lowest + (highest - lowest) * static_cast<float>(k) / (contour_levels - 1);
  }
  const auto contours = contours_around(field, seeds, level, box_around(field, seeds));
  std::array<double, contour_levels> steepness{};
  for (std::size_t k = 0; k < contour_levels; ++k) steepness[k] = steepness_of(contours[k], floor);
  auto k = static_cast<std::size_t>(std::max_element(steepness.begin(), steepness.end()) - steepness.begin());
  const double enough = std::min(cones, share_of_best * steepness[k]);
  const double best = steepness[k];
  while (k > 0 && steepness[k - 1] >= enough) --k;
  return {metric ? level[k] : std::max(level[k], halfway * floor), best};
}

void grow_to_foot(const DepthField& field, float level, float least, BoxMask& region) {
  constexpr double beyond = 1.5;         // a foot is round
  constexpr float above_hollow = 0.15F;  // of the depth at the outline, over what lies around
  const Contour contour = contour_of(field, region);
  if (contour.slope <= 0) return;
  const double radius = std::sqrt(contour.area / std::numbers::pi);
  const auto run = [&](float drop) { return static_cast<int>(std::ceil(std::min(drop / contour.slope, radius))); };
  const int reach = std::max(1, run(level));
  const float hollow = std::clamp(median_around(field, region, reach, 2 * reach + 1), 0.0F, level);
  const int steps = static_cast<int>(std::ceil(beyond * run(level - hollow)));
  grow_over(field, std::max(least, hollow + above_hollow * (level - hollow)), steps, region);
}

}  // namespace roadstereo

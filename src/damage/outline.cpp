#include "damage/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/binned_selection.hpp"
#include "core/order_statistics.hpp"
#include "damage/contours.hpp"
#include "damage/morphology.hpp"
#include "damage/neighbours.hpp"
#include "damage/robust_normal.hpp"

namespace roadstereo {
namespace {

/// Mean slope on the contour relative to that of a cone of the same area and of depth `floor`.
double steepness_of(const ContourStatistics& contour, float floor) {
  return contour.slope * std::sqrt(contour.area / std::numbers::pi) / floor;
}

/// Box in which contours around the seeds are measured.
CellBox search_box(const DepthField& field, const ConnectedComponent& seeds) {
  const int size = std::max(seeds.box.columns(), seeds.box.rows());
  return seeds.box.grown(size + 16, field.depth.width(), field.depth.height());
}

/// Calls add(i, j, depth) for the allowed cells between two distances from a region.
template <class Add>
void visit_between(const DepthField& field, const BoxMask& region, int near, int far, const Add& add) {
  const CellBox around = region.box().grown(far, field.depth.width(), field.depth.height());
  const BoxMask inner = dilate(region, near, around);
  const BoxMask outer = dilate(region, far, around);
  for (int j = around.first_row; j <= around.last_row; ++j) {
    const std::uint8_t* const is_inner = inner.cells().row(j - around.first_row);
    const std::uint8_t* const is_outer = outer.cells().row(j - around.first_row);
    const float* const depth = field.depth.row(j) + around.first_column;
    const std::uint8_t* const allowed = field.allowed.row(j) + around.first_column;
    for (int i = 0; i < around.columns(); ++i) {
      if ((is_outer[i] & ~is_inner[i] & allowed[i]) != 0) add(around.first_column + i, j, depth[i]);
    }
  }
}

std::vector<float> depths_between(const DepthField& field, const BoxMask& region, int near, int far) {
  std::vector<float> depths;
  visit_between(field, region, near, far, [&](int, int, float depth) { depths.push_back(depth); });
  return depths;
}

/// Median depth of the allowed cells between two distances from a region; 0 if there is none.
float median_around(const DepthField& field, const BoxMask& region, int near, int far) {
  const std::vector<float> depths = depths_between(field, region, near, far);
  return depths.empty() ? 0 : binned_median(depths);
}

/// Depth halfway between the floor and the surroundings: the edge of a step that was smoothed. A wide hollow around a
/// pothole belongs to the surroundings.
float half_height(const DepthField& field, const ConnectedComponent& seeds, float floor, float min_level) {
  constexpr int iterations = 2;
  constexpr int near_cells = 3;  // closer to the rim the depth is smoothed
  constexpr double band_radii = 0.3;
  float level = std::max(min_level, 0.5F * floor);
  for (int k = 0; k < iterations; ++k) {
    const RobustNormal around = depths_around(field, flood_fill(field, seeds, level), near_cells, band_radii);
    level = std::max(min_level, 0.5F * (floor + static_cast<float>(around.median)));
  }
  return level;
}

/// Add the allowed neighbours with depths from `min_depth` to `max_depth`, `steps` times.
void grow_between(const DepthField& field, float min_depth, float max_depth, int steps, BoxMask& region) {
  const int columns = field.depth.width();
  const int rows = field.depth.height();
  std::vector<CellIndex> front = contour_cells(region, columns, rows);
  region = region.cropped(region.box().grown(steps, columns, rows));
  std::vector<CellIndex> next;
  for (int k = 0; k < steps && !front.empty(); ++k) {
    next.clear();
    for (const CellIndex cell : front) {
      for_each_neighbour(cell.column, cell.row, columns, rows, [&](int i, int j) {
        const float depth = field.depth(i, j);
        if (region(i, j) || field.allowed(i, j) == 0 || depth <= min_depth || depth > max_depth) return;
        region.set(i, j);
        next.push_back({i, j});
      });
    }
    front.swap(next);
  }
}

/// Cells of a box whose depth a gap may have smeared: within a support window of it, or three of its own radii if that
/// is less, as of a speck of failed matches.
BoxMask near_gaps(const Image<std::uint8_t>& valid, const CellBox& box, int window_radius) {
  Image<std::uint8_t> in_box(box.columns(), box.rows());
  for (int j = 0; j < box.rows(); ++j) {
    std::copy_n(valid.row(box.first_row + j) + box.first_column, box.columns(), in_box.row(j));
  }
  constexpr double smeared_radii = 3;
  BoxMask near(box);
  for (const ConnectedComponent& gap : ConnectedComponents(in_box, ConnectedComponents::Foreground::zero)) {
    const double radius = std::sqrt(static_cast<double>(gap.size) / std::numbers::pi);
    const int reach = std::min(window_radius, static_cast<int>(std::lround(smeared_radii * radius)));
    for (const CellRun& run : gap.runs) {
      const int first = std::max(0, run.first - reach), last = std::min(box.columns() - 1, run.last + reach);
      for (int j = std::max(0, run.row - reach); j <= std::min(box.rows() - 1, run.row + reach); ++j) {
        std::fill(near.cells().row(j) + first, near.cells().row(j) + last + 1, std::uint8_t{255});
      }
    }
  }
  return near;
}

/// Far side of the band around a region, cells from it.
int far_side(const BoxMask& region, int near_cells, double band_radii) {
  constexpr int min_band_cells = 3;
  const double radius = std::sqrt(static_cast<double>(cell_count(region)) / std::numbers::pi);
  return near_cells + std::max(min_band_cells, static_cast<int>(band_radii * radius));
}

}  // namespace

RobustNormal depths_around(const DepthField& field, const BoxMask& region, int near_cells, double band_radii) {
  std::vector<float> around = depths_between(field, region, near_cells, far_side(region, near_cells, band_radii));
  return robust_normal(around);
}

BandAround band_around(const DepthField& field, const BoxMask& region, int near_cells, double band_radii) {
  const Octants octants(region.box());
  std::array<std::vector<float>, Octants::count> depths;
  visit_between(field, region, near_cells, far_side(region, near_cells, band_radii),
                [&](int i, int j, float depth) { depths[octants.of(i, j)].push_back(depth); });
  std::vector<float> values;
  const auto normal_of = [&](std::size_t first, std::size_t count) {
    values.clear();
    for (std::size_t k = first; k < first + count; ++k) {
      const std::vector<float>& octant = depths[k % Octants::count];
      values.insert(values.end(), octant.begin(), octant.end());
    }
    return robust_normal(values);
  };
  BandAround band;
  band.whole = normal_of(0, Octants::count);
  for (std::size_t first = 0; first < Octants::count; ++first) {
    band.halves[first] = normal_of(first, Octants::count / 2);
  }
  return band;
}

float floor_of(std::vector<float> depths) {
  constexpr int iterations = 2;
  BinnedSelection selection;
  const auto upper_quartile = [&] {
    const auto [low, high] = range_of(depths);
    selection.bin(depths, low, high);
    return selection.select(nearest_rank(0.75, depths.size()));
  };
  float floor = upper_quartile();
  for (int k = 0; k < iterations; ++k) {
    std::erase_if(depths, [floor](float depth) { return depth < 0.5F * floor; });
    floor = upper_quartile();
  }
  return floor;
}

float floor_depth(const Image<float>& depth, const ConnectedComponent& seeds) {
  std::vector<float> depths;
  depths.reserve(seeds.size);
  for (const CellRun& run : seeds.runs) {
    const float* const row = depth.row(run.row);
    depths.insert(depths.end(), row + run.first, row + run.last + 1);
  }
  return floor_of(std::move(depths));
}

BoxMask flood_fill(const DepthField& field, const ConnectedComponent& seeds, float level) {
  const int columns = field.depth.width();
  CellBox box;
  std::vector<CellRun> runs;
  // Adds the runs of a row that have a cell from `first` to `last`.
  const auto add_runs = [&](int row, int first, int last) {
    const float* const depth = field.depth.row(row);
    const std::uint8_t* const allowed = field.allowed.row(row);
    std::uint8_t* const visited = field.visited.row(row);
    const auto is_open = [&](int i) { return visited[i] == 0 && allowed[i] != 0 && depth[i] > level; };
    for (int i = first; i <= last; ++i) {
      if (!is_open(i)) continue;
      CellRun run{row, i, i};
      while (run.first > 0 && is_open(run.first - 1)) --run.first;
      while (run.last + 1 < columns && is_open(run.last + 1)) ++run.last;
      std::fill(visited + run.first, visited + run.last + 1, std::uint8_t{255});
      box.add_run(row, run.first, run.last);
      runs.push_back(run);
      i = run.last + 1;
    }
  };
  for (const CellRun& run : seeds.runs) add_runs(run.row, run.first, run.last);
  std::size_t next = 0;
  while (next < runs.size()) {
    const CellRun run = runs[next++];
    if (run.row > 0) add_runs(run.row - 1, run.first, run.last);
    if (run.row + 1 < field.depth.height()) add_runs(run.row + 1, run.first, run.last);
  }
  BoxMask region(box);
  for (const CellRun& run : runs) {
    const int count = run.last - run.first + 1;
    std::fill_n(region.cells().row(run.row - box.first_row) + (run.first - box.first_column), count, std::uint8_t{255});
    std::fill_n(field.visited.row(run.row) + run.first, count, std::uint8_t{0});
  }
  return region;
}

Outline find_outline(const DepthField& field, const ConnectedComponent& seeds, float floor, float min_level,
                     bool metric) {
  constexpr double wall_steepness = 3;  // of a wall; the rim of a paraboloid has 2
  constexpr double min_share = 0.9;     // of the maximum steepness, if that is below wall_steepness
  constexpr float max_level_share = 0.9F;
  const float max_level = std::max(min_level, max_level_share * floor);
  std::array<float, contour_level_count> level{};
  for (std::size_t k = 0; k < contour_level_count; ++k) {
    level[k] = min_level + (max_level - min_level) * static_cast<float>(k) / (contour_level_count - 1);
  }
  const auto contours = measure_contours(field, seeds, level, search_box(field, seeds));
  std::array<double, contour_level_count> steepness{};
  for (std::size_t k = 0; k < contour_level_count; ++k) steepness[k] = steepness_of(contours[k], floor);
  auto k = static_cast<std::size_t>(std::max_element(steepness.begin(), steepness.end()) - steepness.begin());
  const double max_steepness = steepness[k];
  const double min_steepness = std::min(wall_steepness, min_share * max_steepness);
  while (k > 0 && steepness[k - 1] >= min_steepness) --k;
  return {metric ? level[k] : half_height(field, seeds, floor, min_level), max_steepness};
}

void grow_over_gaps(const DepthField& field, const Image<std::uint8_t>& valid, float min_level, int window_radius,
                    BoxMask& region) {
  constexpr int near_windows = 3;  // farther than the smeared depths of the wall
  constexpr double band_radii = 1;
  constexpr double min_sigmas = 2.5;  // from the depths around
  constexpr int max_windows = 4;      // growth
  const int columns = field.depth.width(), rows = field.depth.height();
  const RobustNormal around = depths_around(field, region, near_windows * window_radius, band_radii);
  const float min_depth = std::max(min_level, static_cast<float>(around.median + min_sigmas * around.sigma));
  const CellBox wide = region.box().grown(max_windows * window_radius, columns, rows);
  const BoxMask near_gap = near_gaps(valid, wide, window_radius);
  std::vector<CellIndex> front = contour_cells(region, columns, rows);
  region = region.cropped(wide);
  while (!front.empty()) {
    const CellIndex cell = front.back();
    front.pop_back();
    for_each_neighbour(cell.column, cell.row, columns, rows, [&](int i, int j) {
      if (!near_gap(i, j) || region(i, j) || field.allowed(i, j) == 0 || field.depth(i, j) <= min_depth) return;
      region.set(i, j);
      front.push_back({i, j});
    });
  }
}

void grow_to_wall_foot(const DepthField& field, float level, float min_depth, BoxMask& region) {
  constexpr double rounding = 1.5;   // the wall flattens towards its foot
  constexpr float min_rise = 0.15F;  // above the surroundings, of the depth at the outline
  const ContourStatistics contour = measure_contour(field, region);
  if (contour.slope <= 0) return;
  const double radius = std::sqrt(contour.area / std::numbers::pi);
  // Cells in which the extrapolated wall rises by `drop`.
  const auto run = [&](float drop) { return static_cast<int>(std::ceil(std::min(drop / contour.slope, radius))); };
  const int full_run = std::max(1, run(level));
  const float hollow = std::clamp(median_around(field, region, full_run, 2 * full_run + 1), 0.0F, level);
  const int steps = static_cast<int>(std::ceil(rounding * run(level - hollow)));
  // What rises above the level again is another damage.
  grow_between(field, std::max(min_depth, hollow + min_rise * (level - hollow)), level, steps, region);
}

}  // namespace roadstereo

#include "damage/outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.hpp"

namespace roadstereo {
namespace {

constexpr int levels = 24;

float depth_at(const DepthField& field, std::int32_t cell) {
  return field.depth(cell % field.depth.width(), cell / field.depth.width());
}

/// Depth that three quarters of the seeds do not reach: the floor, whatever single cells say.
float floor_depth(const DepthField& field, const std::vector<std::int32_t>& seeds) {
  std::vector<float> depths;
  depths.reserve(seeds.size());
  for (const std::int32_t cell : seeds) depths.push_back(depth_at(field, cell));
  const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 3 / 4);
  std::nth_element(depths.begin(), at, depths.end());
  return *at;
}

float slope_at(const Image<float>& depth, int i, int j) {
  const int left = std::max(0, i - 1);
  const int right = std::min(depth.width() - 1, i + 1);
  const int above = std::max(0, j - 1);
  const int below = std::min(depth.height() - 1, j + 1);
  const float along = (depth(right, j) - depth(left, j)) / static_cast<float>(std::max(1, right - left));
  const float down = (depth(i, below) - depth(i, above)) / static_cast<float>(std::max(1, below - above));
  return std::hypot(along, down);
}

bool on_contour(const Image<std::uint8_t>& region, int i, int j) {
  return (i > 0 && region(i - 1, j) == 0) || (i + 1 < region.width() && region(i + 1, j) == 0) ||
         (j > 0 && region(i, j - 1) == 0) || (j + 1 < region.height() && region(i, j + 1) == 0);
}

struct Contour {
  double slope = 0;  ///< mean along it, pixels of ℓ' per cell
  double area = 0;   ///< inside, cells
};

Contour contour_of(const DepthField& field, const Image<std::uint8_t>& region, const Box& within) {
  double slopes = 0;
  int contour = 0;
  double area = 0;
  for (int j = within.first_row; j <= within.last_row; ++j) {
    for (int i = within.first_column; i <= within.last_column; ++i) {
      if (region(i, j) == 0) continue;
      ++area;
      if (!on_contour(region, i, j)) continue;
      slopes += slope_at(field.depth, i, j);
      ++contour;
    }
  }
  return {contour == 0 ? 0 : slopes / contour, area};
}

/// Mean slope along the contour against that of a cone of its opening and of depth `floor`.
double steepness_of(const Contour& contour, float floor) {
  return contour.slope * std::sqrt(contour.area / std::numbers::pi) / floor;
}

Box box_around(const DepthField& field, const std::vector<std::int32_t>& seeds) {
  Box box;
  for (const std::int32_t cell : seeds) box.add(cell % field.depth.width(), cell / field.depth.width());
  const int size = std::max(box.last_column - box.first_column, box.last_row - box.first_row) + 1;
  return box.grown(size + 16, field.depth.width(), field.depth.height());
}

Box box_of(const Image<std::uint8_t>& region) {
  Box box;
  for (int j = 0; j < region.height(); ++j) {
    for (int i = 0; i < region.width(); ++i) {
      if (region(i, j) != 0) box.add(i, j);
    }
  }
  return box;
}

/// Median depth of the cells between two distances from a region; 0 where none is known.
float median_around(const DepthField& field, const Image<std::uint8_t>& region, const Box& box, int near, int far) {
  const Box around = box.grown(far, region.width(), region.height());
  const Image<std::uint8_t> inner = grow(region, near, around);
  const Image<std::uint8_t> outer = grow(region, far, around);
  std::vector<float> depths;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    for (int i = around.first_column; i <= around.last_column; ++i) {
      if (outer(i, j) != 0 && inner(i, j) == 0 && field.allowed(i, j) != 0) depths.push_back(field.depth(i, j));
    }
  }
  return depths.empty() ? 0 : take_median(depths);
}

}  // namespace

Image<std::uint8_t> flood(const DepthField& field, const std::vector<std::int32_t>& seeds, float level,
                          const Box& within) {
  const int width = field.depth.width();
  Image<std::uint8_t> region(width, field.depth.height(), 0);
  std::vector<std::int32_t> open;
  const auto take = [&](int i, int j) {
    if (i < within.first_column || i > within.last_column || j < within.first_row || j > within.last_row) return;
    if (region(i, j) != 0 || field.allowed(i, j) == 0 || field.depth(i, j) <= level) return;
    region(i, j) = 255;
    open.push_back(j * width + i);
  };
  for (const std::int32_t cell : seeds) take(cell % width, cell / width);
  while (!open.empty()) {
    const int i = open.back() % width;
    const int j = open.back() / width;
    open.pop_back();
    take(i - 1, j);
    take(i + 1, j);
    take(i, j - 1);
    take(i, j + 1);
  }
  return region;
}

Outline find_outline(const DepthField& field, const std::vector<std::int32_t>& seeds, float lowest, bool metric) {
  constexpr double cones = 3;            // a paraboloid's rim is twice as steep as the cone
  constexpr double share_of_best = 0.9;  // where nothing is that steep
  constexpr float highest_share = 0.9F;
  constexpr float halfway = 0.6F;
  const float floor = floor_depth(field, seeds);
  const float highest = std::max(lowest, highest_share * floor);
  const Box within = box_around(field, seeds);
  std::vector<float> level(levels);
  std::vector<double> steepness(levels);
  for (std::size_t k = 0; k < levels; ++k) {
    level[k] = lowest + (highest - lowest) * static_cast<float>(k) / (levels - 1);
    steepness[k] = steepness_of(contour_of(field, flood(field, seeds, level[k], within), within), floor);
  }
  auto k = static_cast<std::size_t>(std::max_element(steepness.begin(), steepness.end()) - steepness.begin());
  const double enough = std::min(cones, share_of_best * steepness[k]);
  const double best = steepness[k];
  while (k > 0 && steepness[k - 1] >= enough) --k;
  return {metric ? level[k] : std::max(level[k], halfway * floor), floor, best};
}

void grow_to_foot(const DepthField& field, float level, float least, Image<std::uint8_t>& region) {
  constexpr double beyond = 1.5;         // a foot is round
  constexpr float above_hollow = 0.15F;  // of the depth at the outline, over what lies around
  const Box box = box_of(region);
  const Contour contour = contour_of(field, region, box);
  if (contour.slope <= 0) return;
  const double radius = std::sqrt(contour.area / std::numbers::pi);
  const auto run = [&](float drop) { return static_cast<int>(std::ceil(std::min(drop / contour.slope, radius))); };
  const int reach = std::max(1, run(level));
  const float hollow = std::clamp(median_around(field, region, box, reach, 2 * reach + 1), 0.0F, level);
  const int steps = static_cast<int>(std::ceil(beyond * run(level - hollow)));
  const float lowest = std::max(least, hollow + above_hollow * (level - hollow));
  for (int k = 0; k < steps; ++k) {
    const Image<std::uint8_t> last = region;
    const Box around = box.grown(k + 1, region.width(), region.height());
    for (int j = around.first_row; j <= around.last_row; ++j) {
      for (int i = around.first_column; i <= around.last_column; ++i) {
        if (last(i, j) != 0 || field.allowed(i, j) == 0 || field.depth(i, j) <= lowest) continue;
        const bool beside = (i > 0 && last(i - 1, j) != 0) || (i + 1 < last.width() && last(i + 1, j) != 0) ||
                            (j > 0 && last(i, j - 1) != 0) || (j + 1 < last.height() && last(i, j + 1) != 0);
        if (beside) region(i, j) = 255;
      }
    }
  }
}

}  // namespace roadstereo

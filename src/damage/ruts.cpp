#include "damage/ruts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/straightedge.hpp"
#include "damage/transverse_profile.hpp"

namespace roadstereo {
namespace {

/// A rut across the road: columns first … end − 1 of the grid.
struct Rut {
  int first, end;
  double section_m2;            ///< depth times width at half of it
  double significance;          ///< depth in its standard errors
  std::vector<float> depths_m;  ///< of every column
};

/// Finds the ruts of a profile. A rut has shoulders on both sides, on which the straightedge rests and between which
/// there is no step, as of a kerb. It goes on along the road: a pothole or bumps that bend the profile do not.
class RutSearch {
 public:
  explicit RutSearch(const HeightGrid& grid)
      : heights_(grid.heights),
        profile_(fit_profile(grid.heights)),
        gaps_(straightedge_gaps(profile_.heights, profile_bin_m, rut_straightedge_m)),
        visited_(gaps_.size(), false) {}

  std::vector<Rut> find() {
    std::vector<Rut> ruts;
    for (int deepest = deepest_column(); deepest >= 0; deepest = deepest_column()) {
      const std::optional<Rut> rut = rut_around(deepest);
      if (rut) ruts.push_back(*rut);
    }
    return ruts;
  }

 private:
  static constexpr double rut_straightedge_m = 2;  // spans a wheel track and its shoulders
  static constexpr double min_depth_m = 0.005, max_depth_m = 0.08;

  int columns() const { return heights_.width(); }
  double height(int i) const { return profile_.heights[static_cast<std::size_t>(i)]; }
  double gap(int i) const { return gaps_[static_cast<std::size_t>(i)]; }
  double std_error(int i) const { return profile_.std_errors[static_cast<std::size_t>(i)]; }

  /// Column of the deepest gap that was not visited; −1 if it is too shallow.
  int deepest_column() const {
    int deepest = -1;
    double depth = min_depth_m;
    for (int i = 0; i < columns(); ++i) {
      if (visited_[static_cast<std::size_t>(i)] || gap(i) < depth) continue;
      deepest = i;
      depth = gap(i);
    }
    return deepest;
  }

  bool is_below(int i, double depth) const {
    constexpr double min_sigmas = 5, shoulder_share = 0.15;
    return gap(i) > std::max(min_sigmas * std_error(i), shoulder_share * depth);
  }

  /// Columns beside a rut that lie close below the straightedge.
  struct Shoulder {
    int size = 0;
    int support = 0;           ///< the first that the straightedge touches
    double slope_per_bin = 0;  ///< of the nearest ones
  };

  /// Shoulder from column `i` on, in the direction `step`.
  Shoulder shoulder(int i, int step, double depth) const {
    constexpr int max_columns = 8;
    Shoulder result{0, i, 0};
    bool touches = false;
    double sum_i = 0, sum_z = 0, sum_ii = 0, sum_iz = 0;
    for (; result.size < max_columns && i >= 0 && i < columns(); i += step) {
      const double z = height(i);
      if (std::isnan(z) || is_below(i, depth)) break;
      ++result.size;
      sum_i += i;
      sum_z += z;
      sum_ii += static_cast<double>(i) * i;
      sum_iz += i * z;
      if (touches) continue;
      result.support = i;
      touches = gap(i) == 0;
    }
    const double n = result.size;
    if (result.size > 1) result.slope_per_bin = (n * sum_iz - sum_i * sum_z) / (n * sum_ii - sum_i * sum_i);
    return result;
  }

  /// Height of the right shoulder above the left one, less what their mean slope makes: the step of a kerb.
  double step_between(const Shoulder& left, const Shoulder& right) const {
    const double slope = 0.5 * (left.slope_per_bin + right.slope_per_bin);
    return height(right.support) - height(left.support) - slope * (right.support - left.support);
  }

  /// Depth that a fifth of the transverse profiles does not reach, below the line between two columns.
  double persistent_depth(int left, int deepest, int right) const {
    constexpr double share = 0.2;
    const double weight = static_cast<double>(deepest - left) / (right - left);
    std::vector<double> depths;
    for (int j = 0; j < heights_.height(); ++j) {
      const double line = (1 - weight) * heights_(left, j) + weight * heights_(right, j);
      const double depth = line - heights_(deepest, j);
      if (!std::isnan(depth)) depths.push_back(depth);
    }
    return depths.empty() ? 0 : lower_quantile(depths, share);
  }

  std::optional<Rut> rut_around(int deepest) {
    constexpr double max_significance = 1000;  // of maps without noise
    constexpr double min_width_m = 0.25, max_width_m = 0.85, persistent_share = 0.5, max_step_share = 0.5;
    constexpr int min_shoulder_columns = 3;
    const double depth = gap(deepest);
    Rut rut{deepest, deepest + 1, 0, std::min(depth / std_error(deepest), max_significance), {}};
    while (rut.first > 0 && is_below(rut.first - 1, depth)) --rut.first;
    while (rut.end < columns() && is_below(rut.end, depth)) ++rut.end;
    int wide = 0;
    for (int i = rut.first; i < rut.end; ++i) {
      visited_[static_cast<std::size_t>(i)] = true;
      wide += gap(i) > 0.5 * depth ? 1 : 0;
      rut.depths_m.push_back(static_cast<float>(gap(i)));
    }
    const double width = profile_bin_m * wide;
    rut.section_m2 = depth * width;
    if (rut.significance < min_rut_sigmas || depth > max_depth_m || width < min_width_m || width > max_width_m)
      return {};
    const Shoulder left = shoulder(rut.first - 1, -1, depth), right = shoulder(rut.end, 1, depth);
    if (std::min(left.size, right.size) < min_shoulder_columns) return {};
    if (std::abs(step_between(left, right)) > max_step_share * depth) return {};
    if (persistent_depth(left.support, deepest, right.support) < persistent_share * depth) return {};
    return rut;
  }

  const Image<double>& heights_;
  MeanProfile profile_;
  std::vector<double> gaps_;
  std::vector<bool> visited_;
};

/// Ruts along one direction.
struct RutGrid {
  HeightGrid grid;
  std::vector<Rut> ruts;
  double section_m2 = 0;  ///< of all of them
};

RutGrid find_along(const HeightSamples& samples, const Direction& direction) {
  constexpr int min_profiles = 4;
  RutGrid found{grid_heights(samples, direction), {}};
  if (found.grid.heights.height() < min_profiles) return found;
  found.ruts = RutSearch(found.grid).find();
  for (const Rut& rut : found.ruts) found.section_m2 += rut.section_m2;
  return found;
}

/// Label the cells of the ruts of a grid.
Ruts label_cells(const HeightGrid& grid, const std::vector<Rut>& found, const SurfaceCoordinates& coordinates) {
  constexpr std::size_t max_ruts = 255;
  Ruts ruts;
  std::vector<std::uint8_t> label(static_cast<std::size_t>(grid.heights.width()), 0);
  std::vector<float> depth_m(label.size(), 0.0F);
  for (std::size_t k = 0; k < std::min(found.size(), max_ruts); ++k) {
    ruts.floors_m.push_back(*std::max_element(found[k].depths_m.begin(), found[k].depths_m.end()));
    ruts.significances.push_back(found[k].significance);
    std::fill(label.begin() + found[k].first, label.begin() + found[k].end, static_cast<std::uint8_t>(k + 1));
    std::copy(found[k].depths_m.begin(), found[k].depths_m.end(), depth_m.begin() + found[k].first);
  }
  const int width = coordinates.x.width(), height = coordinates.x.height();
  ruts.labels.assign(width, height, 0);
  ruts.depth_m.assign(width, height, 0);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const float x = coordinates.x(i, j), y = coordinates.y(i, j);
      if (std::isnan(x)) continue;
      const int column = grid.column(x, y);
      if (column < 0 || column >= grid.heights.width()) continue;
      ruts.labels(i, j) = label[static_cast<std::size_t>(column)];
      ruts.depth_m(i, j) = depth_m[static_cast<std::size_t>(column)];
    }
  }
  return ruts;
}

}  // namespace

void Ruts::fill(std::uint8_t value, Image<std::uint8_t>& mask) const {
  for (std::size_t k = 0; k < labels.pixels(); ++k) {
    if (labels.row(0)[k] != 0) mask.row(0)[k] = value;
  }
}

Ruts find_ruts(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface,
               double mount_yaw_deg, int threads) {
  constexpr int max_degrees = 30, step_degrees = 5, directions = 2 * max_degrees / step_degrees + 1;
  if (!coordinates.is_metric) return {};
  const HeightSamples samples = sample_heights(cells, coordinates, surface);
  if (samples.all.empty()) return {};
  std::array<RutGrid, directions> found;
  parallel_for(directions, threads, [&](int k, int) {
    const double angle = to_radians(k * step_degrees - max_degrees - mount_yaw_deg);  // from y towards x
    found[static_cast<std::size_t>(k)] = find_along(samples, {std::cos(angle), std::sin(angle)});
  });
  const auto best = std::max_element(found.begin(), found.end(), [](const RutGrid& one, const RutGrid& other) {
    return one.section_m2 < other.section_m2;
  });
  return best->ruts.empty() ? Ruts() : label_cells(best->grid, best->ruts, coordinates);
}

}  // namespace roadstereo

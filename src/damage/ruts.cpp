#include "damage/ruts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/straightedge.hpp"
#include "damage/sampling_step.hpp"

namespace roadstereo {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double bin_m = 0.1;  ///< spacing of the heights of a transverse profile

/// A sampled cell: its place on the road and its height about a plane, metres.
struct Sample {
  double x, y, height;
};

struct Samples {
  std::vector<Sample> all;
  std::vector<Sample> ends;  ///< first and last of every row of the image, which is a line on the road
};

/// Sample cells on the road and its relief, as far as a row of pixels covers 0.3 m of road.
Samples sample_heights(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface) {
  constexpr double max_samples = 6'000;
  constexpr float max_relief_m = 0.06F, max_row_m = 0.3F, max_sigmas = 3;
  const int step = sampling_step({0, 0, cells.width() - 1, cells.height() - 1}, max_samples, 1);
  const float max_distance = max_sigmas * static_cast<float>(surface.noise);
  const float max_cell_m = max_row_m * static_cast<float>(cells.factor);
  Samples samples;
  std::vector<float> values;
  for (int j = 1; j < cells.height(); j += step) {
    const std::size_t first = samples.all.size();
    for (int i = step / 2; i < cells.width(); i += step) {
      const float scale = coordinates.scale(i, j), value = cells.value(i, j);
      const bool on_road = std::abs(value - surface.value(i, j)) <= std::max(max_distance, max_relief_m * scale);
      const bool near = std::abs(coordinates.y(i, j) - coordinates.y(i, j - 1)) <= max_cell_m;
      if (!on_road || !near) continue;
      samples.all.push_back({coordinates.x(i, j), coordinates.y(i, j), 1 / scale});
      values.push_back(value);
    }
    if (samples.all.size() == first) continue;
    samples.ends.push_back(samples.all[first]);
    samples.ends.push_back(samples.all.back());
  }
  if (samples.all.empty()) return samples;
  std::vector<float> sorted = values;
  const float plane = upper_median(sorted);
  for (std::size_t k = 0; k < values.size(); ++k) samples.all[k].height *= values[k] - plane;
  return samples;
}

/// A direction of the road, from the y axis of its coordinates, positive towards x.
struct Direction {
  double cosine = 1, sine = 0;

  double across(double x, double y) const { return cosine * x - sine * y; }
  double along(double x, double y) const { return sine * x + cosine * y; }
};

/// Heights on a grid: rows are transverse profiles; NaN where fewer than three samples lie.
struct HeightGrid {
  Direction direction;
  double first_m = 0;  ///< across the road
  Image<double> heights;

  int column(double x, double y) const {
    return static_cast<int>(std::floor((direction.across(x, y) - first_m) * (1 / bin_m)));
  }
};

HeightGrid grid_heights(const Samples& samples, const Direction& direction) {
  constexpr double min_length_m = 0.5;  // of road of a profile
  constexpr int max_rows = 16, max_columns = 1000, min_samples = 3;
  double first_x = HUGE_VAL, last_x = -HUGE_VAL, first_y = HUGE_VAL, last_y = -HUGE_VAL;
  for (const Sample& sample : samples.ends) {
    const double x = direction.across(sample.x, sample.y), y = direction.along(sample.x, sample.y);
    first_x = std::min(first_x, x);
    last_x = std::max(last_x, x);
    first_y = std::min(first_y, y);
    last_y = std::max(last_y, y);
  }
  const double length = last_y - first_y;
  const int rows = static_cast<int>(std::clamp(length / min_length_m, 1.0, double{max_rows}));
  const int columns = static_cast<int>(std::min((last_x - first_x) / bin_m, max_columns - 1.0)) + 1;
  HeightGrid grid{direction, first_x, Image<double>(columns, rows)};
  Image<int> counts(columns, rows);
  const double rows_per_m = rows / std::max(length, min_length_m);
  for (const Sample& sample : samples.all) {
    const int i = grid.column(sample.x, sample.y);
    const int j = std::min(static_cast<int>((direction.along(sample.x, sample.y) - first_y) * rows_per_m), rows - 1);
    if (i < 0 || i >= columns) continue;
    grid.heights(i, j) += sample.height;
    ++counts(i, j);
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int count = counts(i, j);
      grid.heights(i, j) = count < min_samples ? nan : grid.heights(i, j) / count;
    }
  }
  return grid;
}

/// Transverse profile of all of the road in view.
struct MeanProfile {
  std::vector<double> heights;     ///< metres; NaN where less than half of the road is seen
  std::vector<double> std_errors;  ///< metres
};

/// Deviations of the heights of a row or a column from those that are known.
template <class DeviationAt>
void collect(int count, const DeviationAt& deviation_at, std::vector<double>& deviations) {
  deviations.clear();
  for (int k = 0; k < count; ++k) {
    const double deviation = deviation_at(k);
    if (!std::isnan(deviation)) deviations.push_back(deviation);
  }
}

double mean_of(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Fit a sum of a transverse and a longitudinal profile to the heights, alternately, by means, in the end the former by
/// medians, which a pothole does not bend.
MeanProfile fit_profile(const Image<double>& heights) {
  constexpr int iterations = 3, min_rows = 3;
  const double of_median = std::sqrt(std::numbers::pi / 2);  // standard error of a median over that of a mean
  const int columns = heights.width(), rows = heights.height();
  std::vector<double> across(static_cast<std::size_t>(columns), 0.0), along(static_cast<std::size_t>(rows), 0.0);
  std::vector<std::size_t> counts(across.size());
  std::vector<double> deviations, magnitudes;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (int j = 0; j < rows; ++j) {
      collect(
          columns, [&](int i) { return heights(i, j) - across[static_cast<std::size_t>(i)]; }, deviations);
      along[static_cast<std::size_t>(j)] = mean_of(deviations);
    }
    const bool is_last = iteration + 1 == iterations;
    for (int i = 0; i < columns; ++i) {
      const auto k = static_cast<std::size_t>(i);
      collect(
          rows, [&](int j) { return heights(i, j) - along[static_cast<std::size_t>(j)]; }, deviations);
      counts[k] = deviations.size();
      across[k] = !is_last || deviations.empty() ? mean_of(deviations) : central_median(deviations);
      if (!is_last) continue;
      for (const double deviation : deviations) magnitudes.push_back(std::abs(deviation - across[k]));
    }
  }
  const double sigma = magnitudes.empty() ? 0 : gaussian_mad * upper_median(magnitudes);
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  MeanProfile profile{across, std::vector<double>(across.size())};
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] < std::max<std::size_t>(min_rows, most / 2)) profile.heights[k] = nan;
    profile.std_errors[k] = of_median * sigma / std::sqrt(static_cast<double>(std::max<std::size_t>(counts[k], 1)));
  }
  return profile;
}

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
        gaps_(straightedge_gaps(profile_.heights, bin_m, rut_straightedge_m)),
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
    collect(
        heights_.height(),
        [&](int j) { return (1 - weight) * heights_(left, j) + weight * heights_(right, j) - heights_(deepest, j); },
        depths);
    return depths.empty() ? 0 : lower_quantile(depths, share);
  }

  std::optional<Rut> rut_around(int deepest) {
    constexpr double max_significance = 1000;  // of maps without noise
    constexpr double min_sigmas = 14, min_width_m = 0.25, max_width_m = 0.85, persistent_share = 0.5,
                     max_step_share = 0.5;
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
    const double width = bin_m * wide;
    rut.section_m2 = depth * width;
    if (rut.significance < min_sigmas || depth > max_depth_m || width < min_width_m || width > max_width_m) return {};
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

RutGrid find_along(const Samples& samples, const Direction& direction) {
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

Ruts find_ruts(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface, int threads) {
  constexpr int max_degrees = 30, step_degrees = 5, directions = 2 * max_degrees / step_degrees + 1;
  if (!coordinates.is_metric) return {};
  const Samples samples = sample_heights(cells, coordinates, surface);
  if (samples.all.empty()) return {};
  std::array<RutGrid, directions> found;
  parallel_for(directions, threads, [&](int k, int) {
    const double angle = to_radians(k * step_degrees - max_degrees);
    found[static_cast<std::size_t>(k)] = find_along(samples, {std::cos(angle), std::sin(angle)});
  });
  const auto best = std::max_element(found.begin(), found.end(), [](const RutGrid& one, const RutGrid& other) {
    return one.section_m2 < other.section_m2;
  });
  return best->ruts.empty() ? Ruts() : label_cells(best->grid, best->ruts, coordinates);
}

}  // namespace roadstereo

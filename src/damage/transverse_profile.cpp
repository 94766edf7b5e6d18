#include "damage/transverse_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/order_statistics.hpp"
#include "damage/sampling_step.hpp"

namespace roadstereo {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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

}  // namespace

HeightSamples sample_heights(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface) {
  constexpr double max_samples = 6'000;
  constexpr float max_relief_m = 0.06F, max_row_m = 0.3F, max_sigmas = 3;
  const int step = sampling_step({0, 0, cells.width() - 1, cells.height() - 1}, max_samples, 1);
  const float max_distance = max_sigmas * static_cast<float>(surface.noise);
  const float max_cell_m = max_row_m * static_cast<float>(cells.factor);
  HeightSamples samples;
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

HeightGrid grid_heights(const HeightSamples& samples, const Direction& direction) {
  constexpr double min_length_m = 0.5;  // of road of a profile
  constexpr int max_rows = 16, max_columns = 1000, min_samples = 3;
  double first_x = HUGE_VAL, last_x = -HUGE_VAL, first_y = HUGE_VAL, last_y = -HUGE_VAL;
  for (const HeightSample& sample : samples.ends) {
    const double x = direction.across(sample.x, sample.y), y = direction.along(sample.x, sample.y);
    first_x = std::min(first_x, x);
    last_x = std::max(last_x, x);
    first_y = std::min(first_y, y);
    last_y = std::max(last_y, y);
  }
  const double length = last_y - first_y;
  const int rows = static_cast<int>(std::clamp(length / min_length_m, 1.0, double{max_rows}));
  const int columns = static_cast<int>(std::min((last_x - first_x) / profile_bin_m, max_columns - 1.0)) + 1;
  HeightGrid grid{direction, first_x, Image<double>(columns, rows)};
  Image<int> counts(columns, rows);
  const double rows_per_m = rows / std::max(length, min_length_m);
  for (const HeightSample& sample : samples.all) {
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

}  // namespace roadstereo

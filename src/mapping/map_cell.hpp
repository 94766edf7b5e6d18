#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace roadstereo {

/// Errors of heights of one cell in successive frames.
struct ViewErrors {
  double scale = 1;        ///< variance relative to the square of the standard error, at least 1
  double correlation = 0;  ///< of successive frames; of frames k apart its k-th power (first-order autoregression)

  /// Variance of the mean of n heights, relative to that of independent ones.
  double mean_factor(double n) const {
    const double r = correlation;
    return (1 + r) / (1 - r) - 2 * r * (1 - std::pow(r, n)) / (n * (1 - r) * (1 - r));
  }
};

/// Weighted mean of heights, updated one by one (West 1979).
struct HeightMean {
  float weight = 0;   ///< sum of inverse variances, 1/m²
  float mean = 0;     ///< metres
  float squares = 0;  ///< weighted sum of squared differences from the mean
  std::uint16_t views = 0;

  void add(float height, float variance) {
    const float w = 1 / variance;
    const float difference = height - mean;
    weight += w;
    mean += difference * w / weight;
    squares += w * difference * (height - mean);
    if (views < UINT16_MAX) ++views;
  }

  /// Whether a height belongs to this surface: it differs by less than `sigmas` standard deviations, or than a wall of
  /// 45° rises in a cell.
  bool agrees(float height, float variance, float sigmas, float cell_m) const {
    const float difference = height - mean;
    return difference * difference <= sigmas * sigmas * (variance + 1 / weight) + cell_m * cell_m;
  }

  /// Variance of the mean; larger if the heights of this cell differ by more than is usual. `common_share` of the
  /// variance of a height does not shrink.
  double variance(const ViewErrors& errors, double common_share) const {
    constexpr double prior_views = 4;  // weight of the usual spread against that of this cell
    const double n = views;
    const double spread = (prior_views * errors.scale + squares) / (prior_views + n - 1);
    const double shrunk = common_share * n + (1 - common_share) * errors.mean_factor(n);
    return std::max(errors.scale, spread) * shrunk / weight;
  }
};

/// Measures ViewErrors while heights are added: from the spread of the heights of a cell, and from the differences of
/// successive ones (von Neumann's ratio).
struct ViewErrorSums {
  double spread = 0;       ///< squared differences from the mean of the cell, in variances
  double differences = 0;  ///< squared differences of successive heights, in their variances
  double count = 0;

  void add(const ViewErrorSums& other) {
    spread += other.spread;
    differences += other.differences;
    count += other.count;
  }

  ViewErrors errors() const {
    constexpr double prior_count = 1000, prior_correlation = 1.0 / 3, max_correlation = 0.95;
    // Less spread than expected proves nothing: errors that all frames have in common do not spread.
    constexpr double min_scale = 1, max_scale = 100;
    ViewErrors result;
    result.scale = std::clamp((prior_count + spread) / (prior_count + count), min_scale, max_scale);
    const double independent = (prior_count * (1 - prior_correlation) + differences) / (prior_count + spread);
    result.correlation = std::clamp(1 - independent, 0.0, max_correlation);
    return result;
  }
};

/// What one frame measures of a cell.
struct CellMeasurement {
  float height = 0;     ///< metres
  float variance = 0;   ///< of the height, m²
  float sharpness = 0;  ///< inverse of the area of a pixel on the road, 1/m²
  std::array<float, 3> colour{};
};

/// One cell of the map: the surface that most frames agree on, its rival, and the colour of the surface.
struct MapCell {
  HeightMean surface, rival;
  float last_height = 0, last_variance = 0;  ///< of the surface
  std::array<float, 3> colour{};
  float colour_weight = 0;

  void add(const CellMeasurement& seen, float sigmas, float cell_m, ViewErrorSums& sums) {
    const float height = seen.height, variance = seen.variance;
    if (surface.views == 0 || surface.agrees(height, variance, sigmas, cell_m)) {
      add_to_sums(height, variance, sums);
      surface.add(height, variance);
      last_height = height;
      last_variance = variance;
      add_colour(seen.colour, seen.sharpness);
      return;
    }
    if (rival.views > 0 && !rival.agrees(height, variance, sigmas, cell_m)) rival = {};
    rival.add(height, variance);
    if (rival.views <= surface.views) return;
    std::swap(surface, rival);
    last_height = height;
    last_variance = variance;
    colour_weight = 0;
    add_colour(seen.colour, seen.sharpness);
  }

 private:
  void add_to_sums(float height, float variance, ViewErrorSums& sums) const {
    constexpr int min_views = 6;  // the mean of fewer is correlated with the next height
    if (surface.views < min_views) return;
    const double from_mean = height - surface.mean, from_last = height - last_height;
    sums.spread += from_mean * from_mean / (variance + 1 / surface.weight);
    sums.differences += from_last * from_last / (variance + last_variance);
    ++sums.count;
  }

  void add_colour(const std::array<float, 3>& rgb, float sharpness) {
    colour_weight += sharpness;
    for (std::size_t k = 0; k < 3; ++k) {
      if (colour_weight == sharpness) {
        colour[k] = rgb[k];
      } else {
        colour[k] += (rgb[k] - colour[k]) * sharpness / colour_weight;
      }
    }
  }
};

}  // namespace roadstereo

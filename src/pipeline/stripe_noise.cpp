#include "pipeline/stripe_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

constexpr int band = 16;

/// Samples of a band, of which one in `step` lines is taken.
int samples_of_band(int step) {
  return std::max(1, band / step);
}

/// Set of the band of a sample.
std::size_t band_set(int at, int step) {
  return static_cast<std::size_t>(at / step / samples_of_band(step) % 2);
}

/// Second differences of lines, rows or columns, summed over one set of bands, and their number.
struct LineSums {
  std::vector<int> sum, count;

  explicit LineSums(int lines) : sum(static_cast<std::size_t>(lines)), count(sum.size()) {}
  void add(int line, int differences, int number) {
    sum[static_cast<std::size_t>(line)] += differences;
    count[static_cast<std::size_t>(line)] += number;
  }
};
using BandSums = std::array<LineSums, 2>;

/// Add the second differences along a row, where all three pixels are road, to the sums of their columns. The loop is
/// vectorised.
void add_row(const std::int16_t* level, const std::uint8_t* is_road, int width, int* sum, int* count) {
  for (int u = 1; u + 1 < width; ++u) {
    const int road = (is_road[u - 1] & is_road[u] & is_road[u + 1]) != 0 ? 1 : 0;
    sum[u] += road * (level[u - 1] - 2 * level[u] + level[u + 1]);
    count[u] += road;
  }
}

/// Of some 128 rows.
BandSums sum_columns(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road) {
  constexpr int rows = 128;
  const int step = std::max(1, image.height() / rows);
  BandSums columns{LineSums(image.width()), LineSums(image.width())};
  for (int v = 0; v < image.height(); v += step) {
    LineSums& sums = columns[band_set(v, step)];
    add_row(image.row(v), road.row(v), image.width(), sums.sum.data(), sums.count.data());
  }
  return columns;
}

/// Of some 256 columns.
BandSums sum_rows(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road) {
  constexpr int columns = 256;
  const int width = image.width(), step = std::max(1, width / columns), band_width = samples_of_band(step) * step;
  BandSums rows{LineSums(image.height()), LineSums(image.height())};
  for (int v = 1; v + 1 < image.height(); ++v) {
    const std::int16_t *const above = image.row(v - 1), *const here = image.row(v), *const below = image.row(v + 1);
    const std::uint8_t *const road_above = road.row(v - 1), *const on_road = road.row(v),
                              *const road_below = road.row(v + 1);
    for (int first = 0; first < width; first += band_width) {
      int sum = 0, count = 0;
      for (int u = first; u < std::min(first + band_width, width); u += step) {
        const int is_road = (road_above[u] & on_road[u] & road_below[u]) != 0 ? 1 : 0;
        sum += is_road * (above[u] - 2 * here[u] + below[u]);
        count += is_road;
      }
      rows[band_set(first, step)].add(v, sum, count);
    }
  }
  return rows;
}

/// Variance of the lines' noise: the covariance of both sets is a quarter of the difference of the variances of their
/// sum and difference.
double variance_in_common(const BandSums& lines) {
  constexpr int min_pixels = 16;
  constexpr std::size_t min_lines = 40;
  constexpr double mask_norm = 6;  // 1, −2, 1, squared
  std::vector<double> sums, differences;
  const auto& [first, second] = lines;
  for (std::size_t k = 0; k < first.sum.size(); ++k) {
    if (std::min(first.count[k], second.count[k]) < min_pixels) continue;
    const double one = static_cast<double>(first.sum[k]) / first.count[k],
                 other = static_cast<double>(second.sum[k]) / second.count[k];
    sums.push_back(one + other);
    differences.push_back(one - other);
  }
  if (sums.size() < min_lines) return std::numeric_limits<double>::quiet_NaN();
  const double sum = gaussian_mad * upper_median_magnitude(sums),
               difference = gaussian_mad * upper_median_magnitude(differences);
  return std::max(0.0, (sum * sum - difference * difference) / (4 * mask_norm));
}

}  // namespace

double stripe_variance(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road) {
  return variance_in_common(sum_columns(image, road)) + variance_in_common(sum_rows(image, road));
}

}  // namespace roadstereo

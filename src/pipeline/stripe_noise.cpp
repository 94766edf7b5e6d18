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

/// Set of the band of a sample, of which one in `step` lines is taken.
int band_set(int at, int step) {
  return at / step / std::max(1, band / step) % 2;
}

/// Second differences of a line, a row or a column, summed over the two sets of bands.
struct LineSums {
  std::array<int, 2> sum{}, count{};

  void add(int set, int before, int here, int after, bool is_road) {
    sum[static_cast<std::size_t>(set)] += is_road ? before - 2 * here + after : 0;
    count[static_cast<std::size_t>(set)] += is_road ? 1 : 0;
  }
};

/// Of some 128 rows.
std::vector<LineSums> sum_columns(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road) {
  constexpr int rows = 128;
  const int step = std::max(1, image.height() / rows);
  std::vector<LineSums> columns(static_cast<std::size_t>(image.width()));
  for (int v = 0; v < image.height(); v += step) {
    const std::int16_t* const level = image.row(v);
    const std::uint8_t* const is_road = road.row(v);
    const int set = band_set(v, step);
    for (int u = 1; u + 1 < image.width(); ++u) {
      columns[static_cast<std::size_t>(u)].add(set, level[u - 1], level[u], level[u + 1],
                                               (is_road[u - 1] & is_road[u] & is_road[u + 1]) != 0);
    }
  }
  return columns;
}

/// Of some 256 columns.
std::vector<LineSums> sum_rows(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road) {
  constexpr int columns = 256;
  const int step = std::max(1, image.width() / columns);
  std::vector<LineSums> rows(static_cast<std::size_t>(image.height()));
  for (int v = 1; v + 1 < image.height(); ++v) {
    LineSums& sums = rows[static_cast<std::size_t>(v)];
    for (int u = 0; u < image.width(); u += step) {
      sums.add(band_set(u, step), image(u, v - 1), image(u, v), image(u, v + 1),
               (road(u, v - 1) & road(u, v) & road(u, v + 1)) != 0);
    }
  }
  return rows;
}

/// Variance of the lines' noise: the covariance of both sets is a quarter of the difference of the variances of their
/// sum and difference.
double variance_in_common(const std::vector<LineSums>& lines) {
  constexpr int min_pixels = 16;
  constexpr std::size_t min_lines = 40;
  constexpr double mask_norm = 6;  // 1, −2, 1, squared
  std::vector<double> sums, differences;
  for (const LineSums& line : lines) {
    if (std::min(line.count[0], line.count[1]) < min_pixels) continue;
    const double one = static_cast<double>(line.sum[0]) / line.count[0],
                 other = static_cast<double>(line.sum[1]) / line.count[1];
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

#include "damage/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "damage/pixel_sums.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Squared error of smoothing of a hollow narrower than `reach`, pixels², along the directions in which both sides rise
/// about alike; 0 on walls. Smoothing takes from the depth of such a hollow; that it is one is certain.
float hollow_error2(ImageView<const float> map, int reach, int u, int v) {
  constexpr float min_rise = 0.75;  // of the lower side, of the mean of both
  const float here = map(u, v);
  float sum = 0;
  const auto add = [&](float before, float after) {
    const float rise = std::min(before, after) - here, error = 0.5F * (before + after) - here;
    if (rise > min_rise * error) sum += error * error;
  };
  if (u >= reach && u + reach < map.width()) add(map(u - reach, v), map(u + reach, v));
  if (v >= reach && v + reach < map.height()) add(map(u, v - reach), map(u, v + reach));
  return sum;
}

/// Means of a row of cells of `rows` × `factor` pixels, whose last one the border of the image may clip. The sums have
/// `factor` columns for that one, too. With `known_factor`, unless it is 0, the loops become vectors.
template <int known_factor>
void mean_row(const PixelSums& columns, int factor, int rows, int width, int cells, float* means) {
  const int side = known_factor > 0 ? known_factor : factor, whole = width / side;
  const float* const sums = columns.sum.data();
  const int* const counts = columns.count.data();
  const auto mean = [&](int i, int pixels) {
    float sum = 0;
    int count = 0;
    for (int k = 0; k < side; ++k) {
      sum += sums[i * side + k];
      count += counts[i * side + k];
    }
    const bool valid = count > 0 && 2 * count >= pixels;
    return valid ? sum / static_cast<float>(count) : std::numeric_limits<float>::quiet_NaN();
  };
  for (int i = 0; i < whole; ++i) means[i] = mean(i, rows * side);
  if (whole < cells) means[whole] = mean(whole, rows * (width - whole * side));
}

/// Throws Error unless the map has two different valid values.
void require_variation(ImageView<const float> transformed) {
  std::optional<float> value;
  for (int v = 0; v < transformed.height(); ++v) {
    const float* row = transformed.row(v);
    for (int u = 0; u < transformed.width(); ++u) {
      if (!std::isfinite(row[u])) continue;
      if (value && *value != row[u]) return;
      value = row[u];
    }
  }
  if (!value) fail("the transformed map has no valid pixel");
  fail("the transformed map is constant: every valid pixel is ", *value);
}

}  // namespace

int cell_factor(int width, int height) {
  constexpr double max_cells = 300e3;
  // From this size on, cells of 2×2 pixels lose no detail: the support window of matching is wider.
  constexpr double min_pixels = 57e3;
  const double pixels = static_cast<double>(width) * height;
  return std::max(pixels > min_pixels ? 2 : 1, static_cast<int>(std::ceil(std::sqrt(pixels / max_cells))));
}

Cells make_cells(ImageView<const float> transformed, ImageView<const float> sigma, int smoothing_px, int factor,
                 int threads) {
  constexpr int rows_per_band = 16;
  const int width = transformed.width();
  // Standard errors of a row, without those of smoothing in narrow hollows where they would make a pixel invalid.
  const auto certain = [&](int v, float* errors) -> const float* {
    const float* const row = sigma.row(v);
    if (smoothing_px == 0 || !has_uncertain(row, width)) return row;
    std::copy_n(row, width, errors);
    for (int u = 0; u < width; ++u) {
      if (!(row[u] > max_sigma_px) || std::isnan(transformed(u, v))) continue;
      errors[u] = std::sqrt(std::max(0.0F, row[u] * row[u] - hollow_error2(transformed, smoothing_px, u, v)));
    }
    return errors;
  };
  require_variation(transformed);
  const int height = transformed.height();
  Cells cells;
  cells.factor = factor;
  cells.image_width = transformed.width();
  cells.image_height = height;
  cells.smoothing_px = smoothing_px;
  cells.value.resize((transformed.width() + factor - 1) / factor, (height + factor - 1) / factor);
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    PixelSums columns(cells.width() * factor);
    const std::vector<float> zero_sigma(sigma.empty() ? static_cast<std::size_t>(width) : 0, 0.0F);
    std::vector<float> own(sigma.empty() ? 0 : static_cast<std::size_t>(width));
    for (int j = first; j < last; ++j) {
      columns.clear();
      const int end = std::min((j + 1) * factor, height);
      for (int v = j * factor; v < end; ++v) {
        columns.add(transformed.row(v), sigma.empty() ? zero_sigma.data() : certain(v, own.data()), width);
      }
      const auto mean = factor == 2 ? mean_row<2> : factor == 3 ? mean_row<3> : mean_row<0>;
      mean(columns, factor, end - j * factor, width, cells.width(), cells.value.row(j));
    }
  });
  return cells;
}

}  // namespace roadstereo

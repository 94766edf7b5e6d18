#include "damage/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Sums over the rows of one row of cells, column by column.
struct ColumnSums {
  std::vector<double> sum;
  std::vector<int> count;  ///< of the valid pixels

  explicit ColumnSums(int columns) : sum(static_cast<std::size_t>(columns)), count(static_cast<std::size_t>(columns)) {}
  void clear() {
    std::fill(sum.begin(), sum.end(), 0.0);
    std::fill(count.begin(), count.end(), 0);
  }
  /// Adds a row of the picture.
  void add(const float* values, const float* sigma, int width) {
    constexpr float worst_sigma = 1;  // pixels
    constexpr float largest = std::numeric_limits<float>::max();
    double* const sums = sum.data();
    int* const counts = count.data();
    for (int u = 0; u < width; ++u) {
      const int finite = std::abs(values[u]) <= largest ? 1 : 0;
      const int vague = sigma[u] > worst_sigma ? 1 : 0;
      const int valid = finite & ~vague;
      const float value = valid != 0 ? values[u] : 0.0F;
      counts[u] += valid;
      sums[u] += static_cast<double>(value);
    }
  }
};

/// Means of the cells of a row, from sums whose columns fill them all.
void mean_row(const ColumnSums& columns, int factor, bool last_row, int cells, float* means) {
  for (int i = 0; i < cells; ++i) {
    double sum = 0;
    int count = 0;
    for (int k = i * factor; k < (i + 1) * factor; ++k) {
      sum += columns.sum[static_cast<std::size_t>(k)];
      count += columns.count[static_cast<std::size_t>(k)];
    }
    const bool cut = last_row || i + 1 == cells;  // by the border of the picture
    const bool known = count > 0 && (cut ? 4 : 2) * count >= factor * factor;
    means[i] = known ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
  }
}

void require_values(ImageView<const float> transformed) {
  std::optional<float> one;
  for (int v = 0; v < transformed.height(); ++v) {
    const float* row = transformed.row(v);
    for (int u = 0; u < transformed.width(); ++u) {
      if (!std::isfinite(row[u])) continue;
      if (one && *one != row[u]) return;
      one = row[u];
    }
  }
  if (!one) fail("the transformed map has no valid pixel");
  fail("the transformed map shows nothing: every valid pixel is ", *one);
}

}  // namespace

int cell_factor(int width, int height) {
  constexpr double most_cells = 300e3;
  constexpr double least_pixels = 57e3;  // of a picture whose cells hold more than one: matching's window is wider
  const double pixels = static_cast<double>(width) * height;
  return std::max(pixels > least_pixels ? 2 : 1, static_cast<int>(std::ceil(std::sqrt(pixels / most_cells))));
}

Cells make_cells(ImageView<const float> transformed, ImageView<const float> sigma, int factor, int threads) {
  constexpr int rows_per_band = 16;
  require_values(transformed);
  const int height = transformed.height();
  Cells cells;
  cells.factor = factor;
  cells.image_width = transformed.width();
  cells.image_height = height;
  cells.value.resize((transformed.width() + factor - 1) / factor, (height + factor - 1) / factor);
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    ColumnSums columns(cells.width() * factor);
    const std::vector<float> exact(sigma.empty() ? static_cast<std::size_t>(transformed.width()) : 0, 0.0F);
    for (int j = first; j < last; ++j) {
      columns.clear();
      for (int v = j * factor; v < std::min((j + 1) * factor, height); ++v) {
        columns.add(transformed.row(v), sigma.empty() ? exact.data() : sigma.row(v), transformed.width());
      }
      mean_row(columns, factor, j + 1 == cells.height(), cells.width(), cells.value.row(j));
    }
  });
  return cells;
}

}  // namespace roadstereo

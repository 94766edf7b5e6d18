#include "damage/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 16;

/// Sum and number of the valid pixels of one cell.
struct Sum {
  double sum = 0;
  int count = 0;
};

/// Means over cells of what `value_at` gives for each pixel; NaN is left out.
template <class ValueAt>
Image<float> mean_cells(int width, int height, int factor, int threads, const ValueAt& value_at) {
  const auto sum_of_cell = [&](int i, int j) {
    Sum cell;
    for (int v = j * factor; v < std::min((j + 1) * factor, height); ++v) {
      for (int u = i * factor; u < std::min((i + 1) * factor, width); ++u) {
        const float value = value_at(u, v);
        if (!std::isfinite(value)) continue;
        cell.sum += value;
        ++cell.count;
      }
    }
    return cell;
  };
  Image<float> cells((width + factor - 1) / factor, (height + factor - 1) / factor);
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      for (int i = 0; i < cells.width(); ++i) {
        const Sum cell = sum_of_cell(i, j);
        const bool cut = i + 1 == cells.width() || j + 1 == cells.height();  // by the border of the picture
        const bool known = cell.count > 0 && (cut ? 4 : 2) * cell.count >= factor * factor;
        cells(i, j) = known ? static_cast<float>(cell.sum / cell.count) : std::numeric_limits<float>::quiet_NaN();
      }
    }
  });
  return cells;
}

void require_values(ImageView<const float> transformed) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (int v = 0; v < transformed.height(); ++v) {
    const float* row = transformed.row(v);
    for (int u = 0; u < transformed.width(); ++u) {
      if (!std::isfinite(row[u])) continue;
      lowest = std::min(lowest, row[u]);
      highest = std::max(highest, row[u]);
    }
  }
  if (lowest > highest) fail("the transformed map has no valid pixel");
  if (lowest == highest) fail("the transformed map shows nothing: every valid pixel is ", lowest);
}

}  // namespace

int cell_factor(int width, int height) {
  constexpr double most_cells = 300e3;
  constexpr double least_pixels = 57e3;  // of a picture whose cells hold more than one: matching's window is wider
  const double pixels = static_cast<double>(width) * height;
  return std::max(pixels > least_pixels ? 2 : 1, static_cast<int>(std::ceil(std::sqrt(pixels / most_cells))));
}

Cells make_cells(ImageView<const float> transformed, ImageView<const float> sigma, int factor, int threads) {
  constexpr float worst_sigma = 1;  // pixels
  require_values(transformed);
  Cells cells;
  cells.factor = factor;
  cells.image_width = transformed.width();
  cells.image_height = transformed.height();
  cells.value = mean_cells(transformed.width(), transformed.height(), factor, threads, [&](int u, int v) {
    const bool vague = !sigma.empty() && sigma(u, v) > worst_sigma;
    return vague ? std::numeric_limits<float>::quiet_NaN() : transformed(u, v);
  });
  return cells;
}

}  // namespace roadstereo

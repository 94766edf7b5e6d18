#include "damage/image_outline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "damage/contours.hpp"
#include "damage/morphology.hpp"
#include "damage/neighbours.hpp"
#include "damage/robust_normal.hpp"

namespace roadstereo {
namespace {

/// Values of the cells of a box.
struct BoxMap {
  CellBox box;
  Image<float> values;

  float operator()(int i, int j) const { return values(i - box.first_column, j - box.first_row); }
};

/// Distribution of the cells of `included` that are not in `excluded` (may be null). Robust, since one wall of a dark
/// hole may be sunlit.
RobustNormal tone_of(const BoxMap& grey, const BoxMask& included, const BoxMask* excluded) {
  const CellBox& box = grey.box;
  std::vector<float> values;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (included(i, j) && (excluded == nullptr || !(*excluded)(i, j))) values.push_back(grey(i, j));
    }
  }
  return robust_normal(values);
}

/// Mean grey levels of the cells of a box, 1/16 grey level.
BoxMap grey_cells(const ImageEdges& image_edges, const CellBox& box) {
  const int factor = image_edges.factor;
  BoxMap cells{box, Image<float>(box.columns(), box.rows())};
  for (int j = 0; j < box.rows(); ++j) {
    const int first_v = (box.first_row + j) * factor;
    const int end_v = std::min(first_v + factor, image_edges.grey.height());
    for (int i = 0; i < box.columns(); ++i) {
      const int first_u = (box.first_column + i) * factor;
      const int end_u = std::min(first_u + factor, image_edges.grey.width());
      int sum = 0;
      for (int v = first_v; v < end_v; ++v) {
        for (int u = first_u; u < end_u; ++u) sum += image_edges.grey(u, v);
      }
      cells.values(i, j) = static_cast<float>(sum) / static_cast<float>((end_u - first_u) * (end_v - first_v));
    }
  }
  return cells;
}

/// Grey levels after a 3×3 box filter, which suppresses single stones.
BoxMap smooth_grey_cells(const ImageEdges& image_edges, const CellBox& box, int columns, int rows) {
  const BoxMap grey = grey_cells(image_edges, box.grown(1, columns, rows));
  BoxMap result{box, Image<float>(box.columns(), box.rows())};
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      float sum = 0;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          sum += grey(std::clamp(i + di, 0, columns - 1), std::clamp(j + dj, 0, rows - 1));
        }
      }
      result.values(i - box.first_column, j - box.first_row) = sum / 9;
    }
  }
  return result;
}

}  // namespace

void refine_outline_by_image(const ImageEdges& image_edges, int columns, int rows, BoxMask& region) {
  constexpr double min_difference = 1.5;  // standard deviations
  constexpr std::size_t min_samples = 30;
  const int radius = image_edges.window_radius;
  const CellBox around = region.box().grown(3 * radius, columns, rows);
  const BoxMap grey = smooth_grey_cells(image_edges, around, columns, rows);
  const BoxMask near = dilate(region, radius, around);
  const BoxMask far = dilate(region, 3 * radius, around);
  const RobustNormal inside = tone_of(grey, erode(region, 2, around), nullptr);
  const RobustNormal outside = tone_of(grey, far, &near);
  if (inside.samples < min_samples || outside.samples < min_samples) return;
  const double sigma = std::sqrt(0.5 * (inside.sigma * inside.sigma + outside.sigma * outside.sigma));
  if (std::abs(inside.median - outside.median) < min_difference * sigma || sigma == 0) return;
  const double threshold = threshold_between(inside, outside);
  const bool is_dark = inside.median < outside.median;
  std::vector<CellIndex> front = contour_cells(region, columns, rows);
  region = region.cropped(around);
  while (!front.empty()) {
    const CellIndex cell = front.back();
    front.pop_back();
    for_each_neighbour(cell.column, cell.row, columns, rows, [&](int i, int j) {
      if (region(i, j) || !near(i, j) || (grey(i, j) < threshold) != is_dark) return;
      region.set(i, j);
      front.push_back({i, j});
    });
  }
}

}  // namespace roadstereo

#include "damage/image_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "damage/connected_components.hpp"
#include "damage/contours.hpp"
#include "damage/morphology.hpp"
#include "damage/neighbours.hpp"
#include "damage/octants.hpp"
#include "damage/robust_normal.hpp"

namespace roadstereo {
namespace {

/// Values of the cells of a box.
struct BoxMap {
  CellBox box;
  Image<float> values;

  float operator()(int i, int j) const { return values(i - box.first_column, j - box.first_row); }
};

/// Distribution of the cells of a mask of the same box. Robust, since one wall of a dark hole may be sunlit.
RobustNormal tone_of(const BoxMap& grey, const BoxMask& mask) {
  std::vector<float> values;
  const float* const grey_levels = grey.values.row(0);
  const std::uint8_t* const is_set = mask.cells().row(0);
  for (std::size_t k = 0; k < grey.values.pixels(); ++k) {
    if (is_set[k] != 0) values.push_back(grey_levels[k]);
  }
  return robust_normal(values);
}

/// The road around a region in each octant, since shadows, paint and patches end there.
using OctantTones = std::array<RobustNormal, Octants::count>;

OctantTones octant_tones(const BoxMap& grey, const BoxMask& road, const Octants& octants) {
  std::array<std::vector<float>, Octants::count> values;
  const CellBox& box = grey.box;
  for (int j = 0; j < box.rows(); ++j) {
    const std::uint8_t* const is_road = road.cells().row(j);
    const float* const grey_levels = grey.values.row(j);
    for (int i = next_nonzero(is_road, 0, box.columns()); i < box.columns();
         i = next_nonzero(is_road, i + 1, box.columns())) {
      values[octants.of(box.first_column + i, box.first_row + j)].push_back(grey_levels[i]);
    }
  }
  OctantTones tones;
  for (std::size_t k = 0; k < Octants::count; ++k) tones[k] = robust_normal(values[k]);
  return tones;
}

/// Mean grey levels of a row of cells from `first` on, 1/16 grey level.
void read_grey_row(const ImageEdges& image_edges, int first, int count, int row, std::vector<int>& sums, float* means) {
  const int factor = image_edges.factor;
  const int first_u = first * factor, columns = std::min(count * factor, image_edges.grey.width() - first_u);
  const int first_v = row * factor, end_v = std::min(first_v + factor, image_edges.grey.height());
  sums.assign(static_cast<std::size_t>(columns), 0);
  for (int v = first_v; v < end_v; ++v) {
    const std::int16_t* const grey = image_edges.grey.row(v) + first_u;
    for (int u = 0; u < columns; ++u) sums[static_cast<std::size_t>(u)] += grey[u];
  }
  for (int i = 0; i < count; ++i) {
    const int end = std::min((i + 1) * factor, columns);
    int sum = 0;
    for (int u = i * factor; u < end; ++u) sum += sums[static_cast<std::size_t>(u)];
    means[i] = static_cast<float>(sum) / static_cast<float>((end - i * factor) * (end_v - first_v));
  }
}

/// Grey levels of the cells of a box after a 3×3 box filter, which suppresses single stones. The border of the image is
/// replicated.
BoxMap smooth_grey_cells(const ImageEdges& image_edges, const CellBox& box, int columns, int rows) {
  const CellBox around = box.grown(1, columns, rows);
  const int width = box.columns(), height = box.rows();
  Image<float> grey(width + 2, height + 2);  // with a margin of one cell
  std::vector<int> sums;
  for (int j = around.first_row; j <= around.last_row; ++j) {
    float* const row = grey.row(j - box.first_row + 1);
    read_grey_row(image_edges, around.first_column, around.columns(), j, sums,
                  row + (around.first_column - box.first_column + 1));
    if (around.first_column == box.first_column) row[0] = row[1];
    if (around.last_column == box.last_column) row[width + 1] = row[width];
  }
  if (around.first_row == box.first_row) std::copy_n(grey.row(1), width + 2, grey.row(0));
  if (around.last_row == box.last_row) std::copy_n(grey.row(height), width + 2, grey.row(height + 1));
  BoxMap result{box, Image<float>(width, height)};
  for (int j = 0; j < height; ++j) {
    const float *const a = grey.row(j), *const b = grey.row(j + 1), *const c = grey.row(j + 2);
    float* const smooth = result.values.row(j);
    for (int i = 0; i < width; ++i) {
      smooth[i] = (a[i] + a[i + 1] + a[i + 2] + b[i] + b[i + 1] + b[i + 2] + c[i] + c[i + 1] + c[i + 2]) / 9;
    }
  }
  return result;
}

/// Clear `count` cells that are set, 255, in another mask.
void clear(const std::uint8_t* set, int count, std::uint8_t* cells) {
  for (int i = 0; i < count; ++i) cells[i] &= ~set[i];
}

/// Log of the ratio of the likelihoods of a grey level under two normal distributions.
double log_ratio(double grey, const RobustNormal& one, const RobustNormal& other) {
  constexpr double min_sigma = 1;  // the unit, 1/16 grey level
  const double sigma = std::max(one.sigma, min_sigma), other_sigma = std::max(other.sigma, min_sigma);
  const double from_one = (grey - one.median) / sigma, from_other = (grey - other.median) / other_sigma;
  return 0.5 * (from_other * from_other - from_one * from_one) + std::log(other_sigma / sigma);
}

}  // namespace

void refine_outline_by_image(const ImageEdges& image_edges, const Image<std::uint8_t>& hidden,
                             const BoxMask& other_hollows, int window_rows, BoxMask& region) {
  // Prior log-odds of the road: most of these cells were measured on it.
  constexpr double min_log_ratio = 1.5;
  constexpr std::size_t min_samples = 30;
  const int radius = image_edges.window_radius, columns = hidden.width(), rows = hidden.height();
  const CellBox around = region.box().grown(3 * radius, columns, rows);
  const auto clear_hidden = [&](BoxMask& mask) {
    for (int j = 0; j < around.rows(); ++j) {
      clear(hidden.row(around.first_row + j) + around.first_column, around.columns(), mask.cells().row(j));
    }
  };
  BoxMask core = erode(region, 2, around);
  clear_hidden(core);
  if (cell_count(core) < min_samples) return;
  const BoxMask near = dilate(region, radius, window_rows, around);
  BoxMask far = dilate(near, 2 * radius, 2 * window_rows, around);
  clear_hidden(far);
  clear(near.cells().row(0), static_cast<int>(near.cells().pixels()), far.cells().row(0));
  const BoxMap grey = smooth_grey_cells(image_edges, around, columns, rows);
  const Octants octants(region.box());
  const RobustNormal inside = tone_of(grey, core), road = tone_of(grey, far);
  if (road.samples < min_samples || inside.median == road.median) return;
  // What differs even more from the road than the median inside does is at least as good as that.
  const auto ratio = [&](double level, const RobustNormal& outside) {
    const double of_level = log_ratio(level, inside, outside);
    const bool beyond_median = (level < inside.median) == (inside.median < outside.median);
    return beyond_median ? std::max(of_level, log_ratio(inside.median, inside, outside)) : of_level;
  };
  const bool is_dark = inside.median < road.median;
  std::optional<OctantTones> in_octant;  // few regions have cells beside them that differ from all of the road
  const auto is_inside = [&](double level, int i, int j) {
    if ((level < road.median) != is_dark || ratio(level, road) < min_log_ratio) return false;
    if (!in_octant) in_octant = octant_tones(grey, far, octants);
    const RobustNormal& here = (*in_octant)[octants.of(i, j)];
    return here.samples < min_samples || ratio(level, here) > 0;
  };
  std::vector<CellIndex> front = contour_cells(region, columns, rows);
  region = region.cropped(around);
  while (!front.empty()) {
    const CellIndex cell = front.back();
    front.pop_back();
    for_each_neighbour(cell.column, cell.row, columns, rows, [&](int i, int j) {
      if (region(i, j) || !near(i, j) || hidden(i, j) != 0 || other_hollows(i, j) || !is_inside(grey(i, j), i, j))
        return;
      region.set(i, j);
      front.push_back({i, j});
    });
  }
}

}  // namespace roadstereo

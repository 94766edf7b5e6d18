#include "damage/image_outline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.hpp"
#include "damage/contours.hpp"
#include "damage/grow.hpp"
#include "damage/neighbours.hpp"

namespace roadstereo {
namespace {

/// Median of grey levels and their robust standard deviation: a sunlit wall does not make a dark hole grey.
struct Tone {
  double middle = 0;
  double deviation = 0;
  std::size_t cells = 0;
};

/// A map of the cells of a box.
struct BoxMap {
  Box box;
  Image<float> values;

  float operator()(int i, int j) const { return values(i - box.first_column, j - box.first_row); }
};

/// Of the cells that are `inside` and not `without`.
Tone tone_of(const BoxMap& tones, const BoxMask& inside, const BoxMask* without) {
  const Box& box = tones.box;
  std::vector<float> values;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (inside(i, j) && (without == nullptr || !(*without)(i, j))) values.push_back(tones(i, j));
    }
  }
  if (values.empty()) return {};
  const float middle = take_median(values);
  for (float& value : values) value = std::abs(value - middle);
  return {middle, gaussian_mad * take_median(values), values.size()};
}

/// Grey level between two tones at which both are as likely: each as many deviations away.
double border_between(const Tone& one, const Tone& other) {
  return (one.middle * other.deviation + other.middle * one.deviation) / (one.deviation + other.deviation);
}

/// Mean grey levels of the cells of a box, in sixteenths.
BoxMap grey_cells(const Witness& witness, const Box& box) {
  const int factor = witness.factor;
  BoxMap cells{box, Image<float>(box.columns(), box.rows())};
  for (int j = 0; j < box.rows(); ++j) {
    const int first_v = (box.first_row + j) * factor;
    const int end_v = std::min(first_v + factor, witness.grey.height());
    for (int i = 0; i < box.columns(); ++i) {
      const int first_u = (box.first_column + i) * factor;
      const int end_u = std::min(first_u + factor, witness.grey.width());
      int sum = 0;
      for (int v = first_v; v < end_v; ++v) {
        for (int u = first_u; u < end_u; ++u) sum += witness.grey(u, v);
      }
      cells.values(i, j) = static_cast<float>(sum) / static_cast<float>((end_u - first_u) * (end_v - first_v));
    }
  }
  return cells;
}

/// Mean of 3×3 cells: single stones are no edge.
BoxMap smoothed(const Witness& witness, const Box& box, int columns, int rows) {
  const BoxMap grey = grey_cells(witness, box.grown(1, columns, rows));
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

void extend_by_image(const Witness& witness, int columns, int rows, BoxMask& region) {
  constexpr double least_difference = 1.5;  // standard deviations
  constexpr std::size_t least_cells = 30;
  const int reach = witness.reach;
  const Box around = region.box().grown(3 * reach, columns, rows);
  const BoxMap tones = smoothed(witness, around, columns, rows);
  const BoxMask band = grow(region, reach, around);
  const BoxMask beyond = grow(region, 3 * reach, around);
  const Tone inside = tone_of(tones, shrink_mask(region, 2, around), nullptr);
  const Tone outside = tone_of(tones, beyond, &band);
  if (inside.cells < least_cells || outside.cells < least_cells) return;
  const double spread = std::sqrt(0.5 * (inside.deviation * inside.deviation + outside.deviation * outside.deviation));
  if (std::abs(inside.middle - outside.middle) < least_difference * spread || spread == 0) return;
  const double border = border_between(inside, outside);
  const bool dark = inside.middle < outside.middle;
  std::vector<CellIndex> open = contour_cells(region, columns, rows);
  region = region.within(around);
  while (!open.empty()) {
    const CellIndex cell = open.back();
    open.pop_back();
    for_neighbours(cell.column, cell.row, columns, rows, [&](int i, int j) {
      if (region(i, j) || !band(i, j) || (tones(i, j) < border) != dark) return;
      region.set(i, j);
      open.push_back({i, j});
    });
  }
}

}  // namespace roadstereo

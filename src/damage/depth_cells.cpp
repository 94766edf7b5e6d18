#include "damage/depth_cells.hpp"

#include <array>
#include <cmath>

#include "damage/cell_interpolation.hpp"

namespace roadstereo {
namespace {

/// Sums of values and their weights in one resolution.
struct Level {
  Image<float> sum, weight;
};

Level halve(const Level& fine) {
  Level coarse;
  coarse.sum.assign((fine.sum.width() + 1) / 2, (fine.sum.height() + 1) / 2, 0.0F);
  coarse.weight.assign(coarse.sum.width(), coarse.sum.height(), 0.0F);
  for (int j = 0; j < fine.sum.height(); ++j) {
    for (int i = 0; i < fine.sum.width(); ++i) {
      coarse.sum(i / 2, j / 2) += fine.sum(i, j);
      coarse.weight(i / 2, j / 2) += fine.weight(i, j);
    }
  }
  // A coarse cell that knows anything knows it fully: weights would else fade with every step.
  for (int j = 0; j < coarse.sum.height(); ++j) {
    for (int i = 0; i < coarse.sum.width(); ++i) {
      if (coarse.weight(i, j) <= 1) continue;
      coarse.sum(i, j) /= coarse.weight(i, j);
      coarse.weight(i, j) = 1;
    }
  }
  return coarse;
}

/// Sum and weight of the five cells around (i, j) along a row or a column, with weights 1 4 6 4 1.
struct Weighted {
  float sum = 0;
  float weight = 0;
};

Weighted binomial_sum(const Level& level, int i, int j, bool along_row) {
  constexpr std::array<float, 5> binomial{1, 4, 6, 4, 1};
  Weighted total;
  int offset = -2;
  for (const float share : binomial) {
    const int column = along_row ? i + offset : i;
    const int row = along_row ? j : j + offset;
    ++offset;
    if (column < 0 || column >= level.sum.width() || row < 0 || row >= level.sum.height()) continue;
    total.sum += share * level.sum(column, row);
    total.weight += share * level.weight(column, row);
  }
  return total;
}

/// Binomial mean, 5×5, of the cells that have a weight; 0 where none has.
Image<float> smooth(const Level& level) {
  const int width = level.sum.width();
  const int height = level.sum.height();
  Level rows{Image<float>(width, height), Image<float>(width, height)};
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const Weighted total = binomial_sum(level, i, j, true);
      rows.sum(i, j) = total.sum;
      rows.weight(i, j) = total.weight;
    }
  }
  Image<float> result(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const Weighted total = binomial_sum(rows, i, j, false);
      result(i, j) = total.weight > 0 ? total.sum / total.weight : 0;
    }
  }
  return result;
}

}  // namespace

void interpolate_gaps(Image<float>& values, const Image<std::uint8_t>& known) {
  Level level{values, Image<float>(values.width(), values.height())};
  for (int j = 0; j < values.height(); ++j) {
    for (int i = 0; i < values.width(); ++i) {
      level.weight(i, j) = known(i, j) != 0 ? 1.0F : 0.0F;
      if (known(i, j) == 0) level.sum(i, j) = 0;
    }
  }
  std::vector<Level> pyramid{std::move(level)};
  while (pyramid.back().sum.width() > 1 || pyramid.back().sum.height() > 1) pyramid.push_back(halve(pyramid.back()));
  for (std::size_t k = pyramid.size() - 1; k-- > 0;) {
    Level& fine = pyramid[k];
    const Level& coarse = pyramid[k + 1];
    for (int j = 0; j < fine.sum.height(); ++j) {
      for (int i = 0; i < fine.sum.width(); ++i) {
        const float missing = 1 - fine.weight(i, j);
        if (missing <= 0) continue;
        fine.sum(i, j) += missing * at_pixel(coarse.sum, 2, i, j);
        fine.weight(i, j) = 1;
      }
    }
  }
  values = std::move(pyramid.front().sum);
}

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface) {
  DepthCells relief;
  relief.noise = surface.noise;
  Level measured{Image<float>(cells.width(), cells.height(), 0.0F), Image<float>(cells.width(), cells.height(), 0.0F)};
  relief.known.assign(cells.width(), cells.height(), 0);
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      const float depth = surface.value(i, j) - cells.value(i, j);
      if (std::isnan(depth)) continue;
      measured.sum(i, j) = depth;
      measured.weight(i, j) = 1;
      relief.known(i, j) = 255;
    }
  }
  relief.depth = smooth(measured);
  interpolate_gaps(relief.depth, relief.known);
  return relief;
}

}  // namespace roadstereo

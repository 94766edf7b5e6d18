#include "damage/depth_cells.hpp"

#include <array>
#include <cmath>

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

/// Weighted mean with binomial weights (1 4 6 4 1)²/256 of the cells that have a weight.
Image<float> smooth(const Level& level) {
  constexpr int radius = 2;
  constexpr std::array<float, 5> binomial{1, 4, 6, 4, 1};
  const int width = level.sum.width();
  const int height = level.sum.height();
  Level rows{Image<float>(width, height), Image<float>(width, height)};
  const auto add = [&](const Level& from, int i, int j, bool along_row, float& sum, float& weight) {
    for (int k = -radius; k <= radius; ++k) {
      const int column = along_row ? i + k : i;
      const int row = along_row ? j : j + k;
      if (column < 0 || column >= width || row < 0 || row >= height) continue;
      const float share = binomial[static_cast<std::size_t>(k + radius)];
      sum += share * from.sum(column, row);
      weight += share * from.weight(column, row);
    }
  };
  Image<float> result(width, height);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) add(level, i, j, true, rows.sum(i, j) = 0, rows.weight(i, j) = 0);
  }
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      float sum = 0;
      float weight = 0;
      add(rows, i, j, false, sum, weight);
      result(i, j) = weight > 0 ? sum / weight : 0;
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

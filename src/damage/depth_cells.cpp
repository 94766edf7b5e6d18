#include "damage/depth_cells.hpp"

#include <algorithm>
#include <vector>

#include "damage/cell_interpolation.hpp"

namespace roadstereo {
namespace {

/// Sums of values and their weights in one resolution.
struct Level {
  Image<float> sum, weight;
};

/// Adds neighbouring cells of a row in twos.
void add_in_twos(const float* fine, int width, float* coarse) {
  const std::ptrdiff_t twos = width / 2;
  for (std::ptrdiff_t i = 0; i < twos; ++i) coarse[i] = coarse[i] + fine[2 * i] + fine[2 * i + 1];
  if (width % 2 != 0) coarse[width / 2] += fine[width - 1];
}

Level halve(const Level& fine) {
  const int width = fine.sum.width();
  Level coarse;
  coarse.sum.assign((width + 1) / 2, (fine.sum.height() + 1) / 2, 0.0F);
  coarse.weight.assign(coarse.sum.width(), coarse.sum.height(), 0.0F);
  for (int j = 0; j < fine.sum.height(); ++j) {
    add_in_twos(fine.sum.row(j), width, coarse.sum.row(j / 2));
    add_in_twos(fine.weight.row(j), width, coarse.weight.row(j / 2));
  }
  // A coarse cell that knows anything knows it fully: weights would else fade with every step.
  float* const sums = coarse.sum.row(0);
  float* const weights = coarse.weight.row(0);
  for (std::size_t k = 0; k < coarse.sum.pixels(); ++k) {
    const float most = std::max(weights[k], 1.0F);
    sums[k] /= most;
    weights[k] = std::min(weights[k], 1.0F);
  }
  return coarse;
}

/// Fills what is missing in a level from the next coarser one.
void fill_from(const Level& coarse, Level& fine) {
  const int width = fine.sum.width();
  PixelRows rows(coarse.sum, 2, width);
  std::vector<float> filling(static_cast<std::size_t>(width));
  for (int j = 0; j < fine.sum.height(); ++j) {
    float* const weights = fine.weight.row(j);
    float* const sums = fine.sum.row(j);
    if (std::all_of(weights, weights + width, [](float weight) { return weight >= 1; })) continue;
    rows.read(j, filling.data());
    for (int i = 0; i < width; ++i) sums[i] += (1 - weights[i]) * filling[static_cast<std::size_t>(i)];
    std::fill(weights, weights + width, 1.0F);
  }
}

/// Sums of five neighbours with the weights 1 4 6 4 1, along the rows and across them; nothing lies beyond the border.
Image<float> binomial_sums(const Image<float>& values) {
  const int width = values.width();
  const int height = values.height();
  Image<float> along(width, height + 4, 0.0F);  // two empty rows above and below
  std::vector<float> line(static_cast<std::size_t>(width) + 4, 0.0F);
  for (int j = 0; j < height; ++j) {
    std::copy_n(values.row(j), width, line.begin() + 2);
    const float* const cell = line.data();
    float* const row = along.row(j + 2);
    for (int i = 0; i < width; ++i) {
      row[i] = cell[i] + 4 * cell[i + 1] + 6 * cell[i + 2] + 4 * cell[i + 3] + cell[i + 4];
    }
  }
  Image<float> sums(width, height);
  for (int j = 0; j < height; ++j) {
    const float* const first = along.row(j);
    const float* const second = along.row(j + 1);
    const float* const middle = along.row(j + 2);
    const float* const fourth = along.row(j + 3);
    const float* const last = along.row(j + 4);
    float* const row = sums.row(j);
    for (int i = 0; i < width; ++i) row[i] = first[i] + 4 * second[i] + 6 * middle[i] + 4 * fourth[i] + last[i];
  }
  return sums;
}

/// Binomial mean, 5×5, of the cells that have a weight; 0 where none has.
Image<float> smooth(const Level& level) {
  Image<float> means = binomial_sums(level.sum);
  const Image<float> weights = binomial_sums(level.weight);
  float* const mean = means.row(0);
  const float* const weight = weights.row(0);
  for (std::size_t k = 0; k < means.pixels(); ++k) mean[k] /= std::max(weight[k], 1.0F);
  return means;
}

}  // namespace

void interpolate_gaps(Image<float>& values, const Image<std::uint8_t>& known) {
  Level level{std::move(values), Image<float>(known.width(), known.height())};
  const std::uint8_t* const is_known = known.row(0);
  float* const sums = level.sum.row(0);
  float* const weights = level.weight.row(0);
  const std::size_t count = known.pixels();
  for (std::size_t k = 0; k < count; ++k) {
    weights[k] = is_known[k] != 0 ? 1.0F : 0.0F;
    sums[k] = is_known[k] != 0 ? sums[k] : 0.0F;
  }
  std::vector<Level> pyramid{std::move(level)};
  while (pyramid.back().sum.width() > 1 || pyramid.back().sum.height() > 1) pyramid.push_back(halve(pyramid.back()));
  for (std::size_t k = pyramid.size() - 1; k-- > 0;) fill_from(pyramid[k + 1], pyramid[k]);
  values = std::move(pyramid.front().sum);
}

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface) {
  DepthCells relief;
  relief.noise = surface.noise;
  Level measured{Image<float>(cells.width(), cells.height()), Image<float>(cells.width(), cells.height())};
  relief.known.resize(cells.width(), cells.height());
  const float* const road = surface.value.row(0);
  const float* const seen = cells.value.row(0);
  float* const sums = measured.sum.row(0);
  float* const weights = measured.weight.row(0);
  std::uint8_t* const known = relief.known.row(0);
  const std::size_t count = relief.known.pixels();
  for (std::size_t k = 0; k < count; ++k) {
    const float depth = road[k] - seen[k];
    const bool is_known = depth == depth;  // not NaN
    sums[k] = is_known ? depth : 0.0F;
    weights[k] = is_known ? 1.0F : 0.0F;
    known[k] = is_known ? 255 : 0;
  }
  relief.depth = smooth(measured);
  interpolate_gaps(relief.depth, relief.known);
  return relief;
}

}  // namespace roadstereo

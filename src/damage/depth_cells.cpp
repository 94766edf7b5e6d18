#include "damage/depth_cells.hpp"

#include <algorithm>
#include <vector>

#include "damage/cell_interpolation.hpp"

namespace roadstereo {
namespace {

/// Level of a pyramid: weighted sums of values, and their weights, 0 … 1.
struct PyramidLevel {
  Image<float> sum, weight;
};

/// Add pairs of neighbouring cells of a row to the cells of the next coarser level.
void add_pairs(const float* fine, int width, float* coarse) {
  const std::ptrdiff_t pairs = width / 2;
  for (std::ptrdiff_t i = 0; i < pairs; ++i) coarse[i] = coarse[i] + fine[2 * i] + fine[2 * i + 1];
  if (width % 2 != 0) coarse[width / 2] += fine[width - 1];
}

/// Pull: downsample a level by 2.
PyramidLevel pull(const PyramidLevel& fine) {
  const int width = fine.sum.width();
  PyramidLevel coarse;
  coarse.sum.assign((width + 1) / 2, (fine.sum.height() + 1) / 2, 0.0F);
  coarse.weight.assign(coarse.sum.width(), coarse.sum.height(), 0.0F);
  for (int j = 0; j < fine.sum.height(); ++j) {
    add_pairs(fine.sum.row(j), width, coarse.sum.row(j / 2));
    add_pairs(fine.weight.row(j), width, coarse.weight.row(j / 2));
  }
  // Weights saturate at 1. Sums become means where the weight is larger.
  float* const sums = coarse.sum.row(0);
  float* const weights = coarse.weight.row(0);
  for (std::size_t k = 0; k < coarse.sum.pixels(); ++k) {
    sums[k] /= std::max(weights[k], 1.0F);
    weights[k] = std::min(weights[k], 1.0F);
  }
  return coarse;
}

/// Push: fill the cells of weight below 1 from the next coarser level, upsampled bilinearly.
void push(const PyramidLevel& coarse, PyramidLevel& fine) {
  const int width = fine.sum.width();
  RowUpsampler rows(coarse.sum, 2, width);
  std::vector<float> upsampled(static_cast<std::size_t>(width));
  for (int j = 0; j < fine.sum.height(); ++j) {
    float* const weights = fine.weight.row(j);
    float* const sums = fine.sum.row(j);
    if (std::all_of(weights, weights + width, [](float weight) { return weight >= 1; })) continue;
    rows.read(j, upsampled.data());
    for (int i = 0; i < width; ++i) sums[i] += (1 - weights[i]) * upsampled[static_cast<std::size_t>(i)];
    std::fill(weights, weights + width, 1.0F);
  }
}

/// Separable binomial filter 1 4 6 4 1, not normalised. Cells beyond the border are 0.
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

/// Binomial mean, 5×5, of the cells of weight 1; 0 where there is none.
Image<float> binomial_means(const PyramidLevel& level) {
  Image<float> means = binomial_sums(level.sum);
  const Image<float> weights = binomial_sums(level.weight);
  float* const mean = means.row(0);
  const float* const weight = weights.row(0);
  for (std::size_t k = 0; k < means.pixels(); ++k) mean[k] /= std::max(weight[k], 1.0F);
  return means;
}

}  // namespace

void fill_gaps(Image<float>& values, const Image<std::uint8_t>& valid) {
  PyramidLevel level{std::move(values), Image<float>(valid.width(), valid.height())};
  const std::uint8_t* const is_valid = valid.row(0);
  float* const sums = level.sum.row(0);
  float* const weights = level.weight.row(0);
  const std::size_t count = valid.pixels();
  for (std::size_t k = 0; k < count; ++k) {
    weights[k] = is_valid[k] != 0 ? 1.0F : 0.0F;
    sums[k] = is_valid[k] != 0 ? sums[k] : 0.0F;
  }
  std::vector<PyramidLevel> pyramid{std::move(level)};
  while (pyramid.back().sum.width() > 1 || pyramid.back().sum.height() > 1) pyramid.push_back(pull(pyramid.back()));
  for (std::size_t k = pyramid.size() - 1; k-- > 0;) push(pyramid[k + 1], pyramid[k]);
  values = std::move(pyramid.front().sum);
}

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface) {
  DepthCells result;
  result.noise = surface.noise;
  PyramidLevel raw{Image<float>(cells.width(), cells.height()), Image<float>(cells.width(), cells.height())};
  result.valid.resize(cells.width(), cells.height());
  const float* const road = surface.value.row(0);
  const float* const measured = cells.value.row(0);
  float* const sums = raw.sum.row(0);
  float* const weights = raw.weight.row(0);
  std::uint8_t* const valid = result.valid.row(0);
  const std::size_t count = result.valid.pixels();
  for (std::size_t k = 0; k < count; ++k) {
    const float depth = road[k] - measured[k];
    const bool is_valid = depth == depth;  // not NaN
    sums[k] = is_valid ? depth : 0.0F;
    weights[k] = is_valid ? 1.0F : 0.0F;
    valid[k] = is_valid ? 255 : 0;
  }
  result.depth = binomial_means(raw);
  fill_gaps(result.depth, result.valid);
  return result;
}

}  // namespace roadstereo

#include "damage/depth_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/parallel.hpp"
#include "damage/cell_interpolation.hpp"

namespace roadstereo {
namespace {

constexpr int cell_rows_per_band = 32;

/// Level of a pyramid: weighted sums of values, and their weights, 0 … 1.
struct PyramidLevel {
  Image<float> sum, weight;

  PyramidLevel(int width, int height) : sum(width, height), weight(width, height) {}
};

/// Add pairs of neighbouring cells of a row to the cells of the next coarser level.
void add_pairs(const float* fine, int width, float* coarse) {
  const std::ptrdiff_t pairs = width / 2;
  for (std::ptrdiff_t i = 0; i < pairs; ++i) coarse[i] = coarse[i] + fine[2 * i] + fine[2 * i + 1];
  if (width % 2 != 0) coarse[width / 2] += fine[width - 1];
}

/// Weights saturate at 1. Sums become means where the weight is larger.
void saturate(int width, float* sums, float* weights) {
  for (int i = 0; i < width; ++i) {
    sums[i] /= std::max(weights[i], 1.0F);
    weights[i] = std::min(weights[i], 1.0F);
  }
}

/// Pull: downsample a level of width×height cells by 2. `read(j, sums, weights)` writes row j.
template <class ReadRow>
PyramidLevel pull(int width, int height, int threads, const ReadRow& read) {
  PyramidLevel coarse((width + 1) / 2, (height + 1) / 2);
  parallel_rows(coarse.sum.height(), cell_rows_per_band, threads, [&](int first, int last, int) {
    std::vector<float> sums(static_cast<std::size_t>(width)), weights(sums.size());
    for (int j = first; j < last; ++j) {
      for (int fine = 2 * j; fine < std::min(2 * j + 2, height); ++fine) {
        read(fine, sums.data(), weights.data());
        add_pairs(sums.data(), width, coarse.sum.row(j));
        add_pairs(weights.data(), width, coarse.weight.row(j));
      }
      saturate(coarse.sum.width(), coarse.sum.row(j), coarse.weight.row(j));
    }
  });
  return coarse;
}

PyramidLevel pull(const PyramidLevel& fine) {
  const int width = fine.sum.width();
  return pull(width, fine.sum.height(), 1, [&](int j, float* sums, float* weights) {
    std::copy_n(fine.sum.row(j), width, sums);
    std::copy_n(fine.weight.row(j), width, weights);
  });
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

/// Rows of measured depths with two empty cells on each side, and the same rows of indicators of a measurement.
struct DepthRow {
  std::vector<float> depth, weight;

  explicit DepthRow(int width) : depth(static_cast<std::size_t>(width) + 4, 0.0F), weight(depth.size(), 0.0F) {}
  void read(const float* road, const float* measured, int width) {
    float* const depths = depth.data() + 2;
    float* const weights = weight.data() + 2;
    for (int i = 0; i < width; ++i) {
      const float below = road[i] - measured[i];
      const bool is_valid = below == below;  // not NaN
      depths[i] = is_valid ? below : 0.0F;
      weights[i] = is_valid ? 1.0F : 0.0F;
    }
  }
};

/// Binomial filter 1 4 6 4 1, not normalised, along a row of `width` cells that begins with the two before the first.
void binomial_sums(const float* cell, int width, float* sums) {
  for (int i = 0; i < width; ++i) {
    sums[i] = cell[i] + 4 * cell[i + 1] + 6 * cell[i + 2] + 4 * cell[i + 3] + cell[i + 4];
  }
}

/// The last five rows, filtered along the row. Rows beyond the border are 0.
class BinomialRows {
 public:
  explicit BinomialRows(int width) : width_(width), rows_(5 * static_cast<std::size_t>(width), 0.0F) {}
  /// Row j, from −2 on.
  float* row(int j) { return rows_.data() + static_cast<std::ptrdiff_t>((j + 2) % 5) * width_; }
  /// Sum of the filter across the rows around cell i of row j.
  auto sums_at(int j) {
    return [first = row(j - 2), second = row(j - 1), middle = row(j), fourth = row(j + 1), last = row(j + 2)](int i) {
      return first[i] + 4 * second[i] + 6 * middle[i] + 4 * fourth[i] + last[i];
    };
  }

 private:
  int width_;
  std::vector<float> rows_;
};

/// Rows `first` … `last` − 1 of the depth cells: binomial means, 5×5, of the measured cells; 0 where there is none.
void fill_rows(const Cells& cells, const RoadSurface& surface, int first, int last, DepthCells& result) {
  const int width = cells.width();
  DepthRow line(width);
  BinomialRows depths(width), weights(width);
  for (int j = first - 2; j < last + 2; ++j) {
    if (j < 0 || j >= cells.height()) {
      std::fill_n(depths.row(j), width, 0.0F);
      std::fill_n(weights.row(j), width, 0.0F);
    } else {
      line.read(surface.value.row(j), cells.value.row(j), width);
      binomial_sums(line.depth.data(), width, depths.row(j));
      binomial_sums(line.weight.data(), width, weights.row(j));
    }
    if (j >= first && j < last) {
      std::uint8_t* const valid = result.valid.row(j);
      for (int i = 0; i < width; ++i) valid[i] = line.weight[static_cast<std::size_t>(i) + 2] > 0 ? 255 : 0;
    }
    if (j < first + 2) continue;
    const auto depth = depths.sums_at(j - 2), weight = weights.sums_at(j - 2);
    float* const means = result.depth.row(j - 2);
    for (int i = 0; i < width; ++i) means[i] = depth(i) / std::max(weight(i), 1.0F);
  }
}

/// Standard deviation of the Gaussian that walls are spread by, cells: by the binomial mean, and by matching, of whose
/// averaging a third is left at a wall, since refinement stops there (docs/constants.md).
double wall_smoothing(const Cells& cells) {
  constexpr double of_binomial_mean = 1, share_at_walls = 1.0 / 3;
  return std::hypot(of_binomial_mean, share_at_walls * cells.smoothing_px / cells.factor);
}

}  // namespace

void fill_gaps(Image<float>& values, const Image<std::uint8_t>& valid, int threads) {
  const int width = valid.width();
  std::vector<PyramidLevel> pyramid;  // from half the size on
  pyramid.push_back(pull(width, valid.height(), threads, [&](int j, float* sums, float* weights) {
    const float* const value = values.row(j);
    const std::uint8_t* const is_valid = valid.row(j);
    for (int i = 0; i < width; ++i) {
      sums[i] = is_valid[i] != 0 ? value[i] : 0.0F;
      weights[i] = is_valid[i] != 0 ? 1.0F : 0.0F;
    }
  }));
  while (pyramid.back().sum.width() > 1 || pyramid.back().sum.height() > 1) pyramid.push_back(pull(pyramid.back()));
  for (std::size_t k = pyramid.size() - 1; k-- > 0;) push(pyramid[k + 1], pyramid[k]);
  parallel_rows(valid.height(), cell_rows_per_band, threads, [&](int first, int last, int) {
    RowUpsampler rows(pyramid.front().sum, 2, width);
    std::vector<float> upsampled(static_cast<std::size_t>(width));
    for (int j = first; j < last; ++j) {
      const std::uint8_t* const is_valid = valid.row(j);
      if (std::memchr(is_valid, 0, static_cast<std::size_t>(width)) == nullptr) continue;
      rows.read(j, upsampled.data());
      float* const value = values.row(j);
      for (int i = 0; i < width; ++i) value[i] = is_valid[i] != 0 ? value[i] : upsampled[static_cast<std::size_t>(i)];
    }
  });
}

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface, int threads) {
  DepthCells result;
  result.noise = surface.noise;
  result.smoothing = wall_smoothing(cells);
  result.depth.resize(cells.width(), cells.height());
  result.valid.resize(cells.width(), cells.height());
  parallel_rows(cells.height(), cell_rows_per_band, threads,
                [&](int first, int last, int) { fill_rows(cells, surface, first, last, result); });
  fill_gaps(result.depth, result.valid, threads);
  return result;
}

}  // namespace roadstereo

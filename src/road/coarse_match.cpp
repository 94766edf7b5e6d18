#include "road/coarse_match.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "core/shrink.hpp"

namespace roadstereo {
namespace {

// Wide and flat blocks: on a road seen at a slant the disparity changes from row to row, not along them.
constexpr int half_width = 5;
constexpr int half_height = 2;
constexpr int block_pixels = (2 * half_width + 1) * (2 * half_height + 1);

constexpr float least_deviation = 1.2f * grey_scale;  ///< of a block with texture
constexpr float least_correlation = 0.7f;
constexpr float least_margin = 0.03f;  ///< by which the best must beat every other but its neighbours

/// Means and inverse deviations of the blocks of one row; 0 where there is no texture.
struct BlockRow {
  std::vector<float> mean;
  std::vector<float> inverse_deviation;
};

/// Sums of 2·half_width + 1 neighbours, for the columns whose block lies inside.
void slide(const std::vector<float>& columns, std::vector<float>& blocks) {
  const auto last = static_cast<std::ptrdiff_t>(columns.size()) - half_width;
  float* sum = blocks.data();
  std::fill(blocks.begin(), blocks.end(), 0.0f);
  for (int du = -half_width; du <= half_width; ++du) {
    const float* column = columns.data() + du;
    for (std::ptrdiff_t u = half_width; u < last; ++u) sum[u] += column[u];
  }
}

BlockRow describe_blocks(const GreyImage& image, int v) {
  const auto width = static_cast<std::size_t>(image.width());
  std::vector<float> sums(width), squares(width), block_sums(width), block_squares(width);
  for (int row = v - half_height; row <= v + half_height; ++row) {
    for (std::size_t u = 0; u < width; ++u) {
      const auto value = static_cast<float>(image.row(row)[u]);
      sums[u] += value;
      squares[u] += value * value;
    }
  }
  slide(sums, block_sums);
  slide(squares, block_squares);
  BlockRow row{std::vector<float>(width), std::vector<float>(width)};
  for (std::size_t u = half_width; u + half_width < width; ++u) {
    row.mean[u] = block_sums[u] / block_pixels;
    const float variance = block_squares[u] / block_pixels - row.mean[u] * row.mean[u];
    if (variance >= least_deviation * least_deviation) row.inverse_deviation[u] = 1 / std::sqrt(variance);
  }
  return row;
}

/// Best disparity of every pixel of a row.
struct BestRow {
  std::vector<int> d;
  std::vector<float> correlation;

  explicit BestRow(int width)
      : d(static_cast<std::size_t>(width), -1), correlation(static_cast<std::size_t>(width), -1) {}
};

/// Correlations of one row, all disparities: the value for left column u and disparity d is row(d)[u].
class RowCorrelations {
 public:
  RowCorrelations(const GreyImage& left, const GreyImage& right, int v, int disparities)
      : width_(left.width()),
        disparities_(std::min(disparities, width_ - 2 * half_width)),
        values_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(disparities_), -1.0f) {
    const BlockRow left_row = describe_blocks(left, v);
    const BlockRow right_row = describe_blocks(right, v);
    std::vector<float> products(static_cast<std::size_t>(width_));
    std::vector<float> blocks(static_cast<std::size_t>(width_));
    for (int d = 0; d < disparities_; ++d) {
      std::fill(products.begin(), products.end(), 0.0f);
      for (int y = v - half_height; y <= v + half_height; ++y) {
        const std::int16_t* l = left.row(y);
        const std::int16_t* r = right.row(y) - d;
        for (int u = d; u < width_; ++u) {
          products[static_cast<std::size_t>(u)] += static_cast<float>(l[u]) * static_cast<float>(r[u]);
        }
      }
      slide(products, blocks);
      correlate(blocks, left_row, right_row, d);
    }
  }

  int width() const { return width_; }

  BestRow best_of_left() const {
    BestRow best(width_);
    for (int d = 0; d < disparities_; ++d) update(best, row(d), 0, width_, d);
    return best;
  }
  /// Right column x is left column x + d.
  BestRow best_of_right() const {
    BestRow best(width_);
    for (int d = 0; d < disparities_; ++d) update(best, row(d) + d, 0, width_ - d, d);
    return best;
  }
  /// Whether no disparity but the neighbours of the best comes near it.
  bool distinct(int u, int best) const {
    for (int d = 0; d < disparities_; ++d) {
      if (std::abs(d - best) > 2 && row(d)[u] > row(best)[u] - least_margin) return false;
    }
    return true;
  }
  /// Position of the maximum, by a parabola through the best and its neighbours.
  double refine(int u, int d) const {
    if (d == 0 || d + 1 >= disparities_) return d;
    const float before = row(d - 1)[u], after = row(d + 1)[u];
    if (before <= -1 || after <= -1) return d;
    const float curvature = 2 * before + 2 * after - 4 * row(d)[u];
    return curvature < 0 ? d + static_cast<double>((before - after) / curvature) : d;
  }

 private:
  const float* row(int d) const { return values_.data() + static_cast<std::ptrdiff_t>(d) * width_; }

  void correlate(const std::vector<float>& blocks, const BlockRow& left_row, const BlockRow& right_row, int d) {
    float* out = values_.data() + static_cast<std::ptrdiff_t>(d) * width_;
    const float* right_mean = right_row.mean.data() - d;
    const float* right_inverse = right_row.inverse_deviation.data() - d;
    for (int u = d + half_width; u + half_width < width_; ++u) {
      const auto i = static_cast<std::size_t>(u);
      const float deviations = left_row.inverse_deviation[i] * right_inverse[u];
      const float covariance = blocks[i] / block_pixels - left_row.mean[i] * right_mean[u];
      out[u] = deviations > 0 ? covariance * deviations : -1;
    }
  }

  static void update(BestRow& best, const float* values, int first, int last, int d) {
    for (int u = first; u < last; ++u) {
      const auto i = static_cast<std::size_t>(u);
      const bool better = values[u] > best.correlation[i];
      best.d[i] = better ? d : best.d[i];
      best.correlation[i] = better ? values[u] : best.correlation[i];
    }
  }

  int width_;
  int disparities_;
  std::vector<float> values_;
};

/// The reliable matches of one row of the shrunk pair.
void match_row(const GreyImage& left, const GreyImage& right, int v, int disparities, int factor,
               std::vector<DisparityPoint>& matches) {
  const RowCorrelations row(left, right, v, disparities);
  const BestRow from_left = row.best_of_left();
  const BestRow from_right = row.best_of_right();
  for (int u = 0; u < row.width(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    const int d = from_left.d[i];
    if (from_left.correlation[i] < least_correlation) continue;
    if (std::abs(from_right.d[static_cast<std::size_t>(u - d)] - d) > 1 || !row.distinct(u, d)) continue;
    matches.push_back({unshrink(u, factor), unshrink(v, factor), row.refine(u, d) * factor});
  }
}

}  // namespace

std::vector<DisparityPoint> match_coarsely(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                           int factor, double max_disparity_px, int threads) {
  const GreyImage small_left = shrink(left, factor);
  const GreyImage small_right = shrink(right, factor);
  const int disparities = static_cast<int>(max_disparity_px / factor) + 1;
  const int rows = std::max(0, small_left.height() - 2 * half_height);
  std::vector<std::vector<DisparityPoint>> by_row(static_cast<std::size_t>(rows));
  parallel_for(rows, threads, [&](int row, int) {
    match_row(small_left, small_right, row + half_height, disparities, factor, by_row[static_cast<std::size_t>(row)]);
  });
  std::vector<DisparityPoint> matches;
  for (const auto& found : by_row) matches.insert(matches.end(), found.begin(), found.end());
  return matches;
}

}  // namespace roadstereo

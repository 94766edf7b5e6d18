#include "damage/surface_correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "damage/smoothing_error.hpp"
#include "road/cubic.hpp"

namespace roadstereo {
namespace {

constexpr int block_radius = 2;
constexpr std::size_t block_side = 2 * block_radius + 1;
constexpr std::size_t block_pixels = block_side * block_side;
using Block = std::array<float, block_pixels>;

/// ZNCC, 0 if negative; NaN if a value is NaN or a block has no contrast.
float correlation(const Block& one, const Block& other) {
  float a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < block_pixels; ++k) {
    const float x = one[k] - one[block_pixels / 2], y = other[k] - other[block_pixels / 2];  // keeps digits
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  constexpr float n = block_pixels;
  const float variances = (aa - a * a / n) * (bb - b * b / n);
  return variances > 0 ? std::max(0.0F, (ab - a * b / n) / std::sqrt(variances))
                       : std::numeric_limits<float>::quiet_NaN();
}

/// A row of the right image, but for its misalignment.
class RightRow {
 public:
  RightRow(const DamageInput& input, int v) : image_(input.right), misalignment_(input.misalignment), v_(v) {
    if (misalignment_.turn_rad == 0) place_ = place_at(0);
  }

  /// Column x; NaN outside.
  float at(float x) const {
    if (misalignment_.turn_rad == 0) return sample(place_, x);
    return sample(place_at(x), static_cast<float>(double{x} + misalignment_.columns_at(v_)));
  }

 private:
  /// Between which rows it lies, and where.
  struct Place {
    int first = 0;
    bool is_whole = true;
    CubicWeights down{};
  };

  Place place_at(float x) const {
    const double row = v_ + misalignment_.rows_at(double{x}, v_), whole = std::floor(row);
    return {static_cast<int>(whole), row == whole, cubic_weights(static_cast<float>(row - whole))};
  }

  float sample(const Place& place, float u) const {
    if (place.first < 1 || place.first + 2 >= image_.height() || !(u >= 1) ||
        !(u < static_cast<float>(image_.width() - 2))) {
      return std::numeric_limits<float>::quiet_NaN();
    }
    const int column = static_cast<int>(u);
    const CubicWeights across = cubic_weights(u - static_cast<float>(column));
    if (place.is_whole) return in_row(place.first, column, across);
    return weighted(place.down, in_row(place.first - 1, column, across), in_row(place.first, column, across),
                    in_row(place.first + 1, column, across), in_row(place.first + 2, column, across));
  }

  float in_row(int v, int column, const CubicWeights& weight) const {
    const std::int16_t* const at = image_.row(v) + column;
    return weighted(weight, at[-1], at[0], at[1], at[2]);
  }

  ImageView<const std::int16_t> image_;
  const Misalignment& misalignment_;
  int v_;
  Place place_;
};

/// Compares two surfaces by blocks of both images.
class SurfaceComparison {
 public:
  explicit SurfaceComparison(const DamageInput& input) : input_(input) {}

  static bool is_possible(const DamageInput& input) {
    return !input.right.empty() && !input.grey.empty() && !input.disparity.empty();
  }

  /// Vote of the block around (u, v): log of the likelihood ratio of the measured surface to the road at `surface`,
  /// from their correlations, truncated and scaled to [−1, 1]; 0 if either is unknown.
  float vote(int u, int v, float surface) const {
    constexpr float max_log_ratio = 2;  // an object that one camera alone sees counts no more than a block of the road
    if (u < block_radius || v < block_radius || u + block_radius >= input_.grey.width() ||
        v + block_radius >= input_.grey.height()) {
      return 0;
    }
    Block left, measured, road;
    std::size_t k = 0;
    for (int y = v - block_radius; y <= v + block_radius; ++y) {
      const RightRow row(input_, y);
      for (int x = u - block_radius; x <= u + block_radius; ++x, ++k) {
        const float at = static_cast<float>(x) - input_.disparity(x, y);
        left[k] = input_.grey(x, y);
        measured[k] = row.at(at);
        road[k] = row.at(at - (surface - input_.transformed(x, y)));
        if (std::isnan(measured[k] + road[k])) return 0;
      }
    }
    const float along_measured = correlation(left, measured), along_road = correlation(left, road);
    const float log_ratio = log_likelihood(along_measured) - log_likelihood(along_road);
    return std::isnan(log_ratio) ? 0 : std::clamp(log_ratio / max_log_ratio, -1.0F, 1.0F);
  }

 private:
  /// Log likelihood of a block along a surface, but for a constant: grey levels differ by normal noise.
  static float log_likelihood(float correlation) {
    constexpr float min_noise_share = 1e-4F;
    return -0.5F * float{block_pixels} * std::log(std::max(1 - correlation * correlation, min_noise_share));
  }

  const DamageInput& input_;
};

/// Sums over windows of (2·radius + 1)² cells.
Image<double> box_sums(const Image<float>& values, int radius) {
  const int width = values.width(), height = values.height();
  Image<double> integral(width + 1, height + 1, 0), sums(width, height);
  for (int j = 0; j < height; ++j) {
    double row = 0;
    for (int i = 0; i < width; ++i) {
      row += double{values(i, j)};
      integral(i + 1, j + 1) = integral(i + 1, j) + row;
    }
  }
  for (int j = 0; j < height; ++j) {
    const int top = std::max(0, j - radius), bottom = std::min(height, j + radius + 1);
    for (int i = 0; i < width; ++i) {
      const int first = std::max(0, i - radius), last = std::min(width, i + radius + 1);
      sums(i, j) = integral(last, bottom) - integral(first, bottom) - integral(last, top) + integral(first, top);
    }
  }
  return sums;
}

}  // namespace

double surface_significance(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box,
                            double offset) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (!SurfaceComparison::is_possible(input)) return nan;
  constexpr double max_blocks = 2000;
  const int step =
      std::max(block_radius, static_cast<int>(std::ceil(std::sqrt(box.width() * box.height() / max_blocks))));
  const SurfaceComparison comparison(input);
  double votes = 0, blocks = 0;
  for (int v = box.v0; v <= box.v1; v += step) {
    for (int u = box.u0; u <= box.u1; u += step) {
      if (maps.ids(u, v) != id) continue;
      votes += comparison.vote(u, v, maps.surface(u, v) + static_cast<float>(offset));
      blocks += 1;
    }
  }
  const double independent = blocks * std::min(1.0, static_cast<double>(step * step) / block_pixels);
  return blocks > 0 ? votes / blocks * std::sqrt(std::max(1.0, independent)) : nan;
}

bool move_unsupported_cells(const DamageInput& input, const RoadSurface& surface, int threads, Cells& cells) {
  constexpr int step = 2;  // cells from block to block
  constexpr int rows_per_band = 16, window_radius_px = SmoothingError::window_radius_px;
  constexpr float max_sigmas = 3;
  if (!SurfaceComparison::is_possible(input)) return false;
  const auto is_off = [&](int i, int j) {
    return std::abs(surface.value(i, j) - cells.value(i, j)) > max_sigmas * static_cast<float>(surface.noise);
  };
  const SurfaceComparison comparison(input);
  Image<float> votes(cells.width(), cells.height(), 0), blocks(cells.width(), cells.height(), 0);
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) {
      if (j % step != 0) continue;
      for (int i = 0; i < cells.width(); i += step) {
        if (!is_off(i, j)) continue;
        const auto [u, v] = cells.centre(i, j);
        votes(i, j) = comparison.vote(u, v, surface.value(i, j));
        blocks(i, j) = 1;
      }
    }
  });
  const int radius = (window_radius_px + cells.factor - 1) / cells.factor;
  const Image<double> sums = box_sums(votes, radius), counts = box_sums(blocks, radius);
  bool moved = false;
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      const double standard_error = std::sqrt(counts(i, j));
      if (sums(i, j) >= -standard_error || !is_off(i, j)) continue;
      cells.value(i, j) = surface.value(i, j);
      moved = true;
    }
  }
  return moved;
}

}  // namespace roadstereo

#include "road/plane_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/cholesky.hpp"
#include "core/downsample.hpp"
#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "core/tukey.hpp"
#include "road/downsampled_plane.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/masked_blocks.hpp"

namespace roadstereo {
namespace {

constexpr int half_block = 7, block_size = 2 * half_block + 1;

/// What a block says of the plane: its shift, pixels of the downsampled images, and that shift's variance.
struct BlockShift {
  double u = 0, v = 0;
  double shift = 0, variance = 0;
  double correlation = 0;  ///< ZNCC along the plane; 0 where the block is not seen
};

/// Image downsampled and smoothed by the binomial filter 1 4 6 4 1 in both directions; the border is replicated.
class SmoothImage {
 public:
  SmoothImage(ImageView<const std::int16_t> image, int factor)
      : width_(image.width() / factor), height_(image.height() / factor) {
    const std::size_t size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    auto pixels = scratch_vector<std::int16_t>(size);
    auto across = scratch_vector<float>(size);
    values_.resize(size);
    const ImageView<std::int16_t> small(pixels.data(), width_, height_);
    downsample(image, factor, small);
    for (int v = 0; v < height_; ++v) {
      const std::int16_t* const row = small.row(v);
      const auto at = [&](int u) { return static_cast<float>(row[std::clamp(u, 0, width_ - 1)]); };
      float* const out = across.data() + offset(v);
      for (int u = 0; u < width_; ++u) out[u] = at(u - 2) + at(u + 2) + 4 * (at(u - 1) + at(u + 1)) + 6 * at(u);
    }
    for (int v = 0; v < height_; ++v) {
      const auto row = [&](int y) { return across.data() + offset(std::clamp(y, 0, height_ - 1)); };
      const float *const a = row(v - 2), *const b = row(v - 1), *const c = row(v), *const d = row(v + 1),
                         *const e = row(v + 2);
      float* const out = values_.data() + offset(v);
      for (int u = 0; u < width_; ++u) out[u] = (a[u] + e[u] + 4 * (b[u] + d[u]) + 6 * c[u]) / 256;
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const float* row(int v) const { return values_.data() + offset(v); }

 private:
  std::ptrdiff_t offset(int v) const { return static_cast<std::ptrdiff_t>(v) * width_; }

  int width_, height_;
  ScratchVector<float> values_ = scratch_vector<float>();
};

/// Regression of L on T, the right image along the plane, and its gradient G: L = β(T − shift·G) + offset. The sums are
/// those of T, G and R = L − T.
void solve_block(const AlignmentSums<float>& s, BlockShift& block) {
  // The filter leaves the noise correlated: 1 / Σ w² of the binomial filter.
  constexpr double pixels_per_sample = 13.4, min_gain = 0.3;
  constexpr double rounding = 1;  // the unit, 1/16 grey level
  const double n = s.n, t = s.t, g = s.g, r = s.r;
  const double tt = s.tt - t * t / n, tg = s.tg - t * g / n, gg = s.gg - g * g / n;
  const double tr = s.tr - t * r / n, gr = s.gr - g * r / n, rr = s.rr - r * r / n;
  const double ll = tt + 2 * tr + rr, lt = tt + tr, lg = tg + gr;
  const double determinant = tt * gg - tg * tg;
  if (!(determinant > 1e-6 * tt * gg) || !(ll > n * rounding)) return;
  const double gain = (lt * gg - lg * tg) / determinant, slope = (lg * tt - lt * tg) / determinant;
  if (!(gain > min_gain && gain < 1 / min_gain)) return;
  const double left_over = std::max(n * rounding, ll - gain * lt - slope * lg);
  block.shift = -slope / gain;
  block.variance = pixels_per_sample * left_over / n * tt / determinant / (gain * gain);
  block.correlation = std::max(0.0, lt / std::sqrt(ll * tt));
}

class PlaneAlignment {
 public:
  PlaneAlignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                 ImageView<const std::uint8_t> mask, int factor, int threads)
      : left_(left, factor),
        right_(right, factor),
        masked_(mask, factor),
        columns_(left_.width() / block_size),
        rows_(left_.height() / block_size),
        threads_(threads) {}

  int width() const { return left_.width(); }
  int height() const { return left_.height(); }

  ScratchVector<BlockShift> measure(const DisparityPlane& plane) const {
    const auto columns = static_cast<std::size_t>(columns_);
    auto blocks = scratch_vector<BlockShift>(columns * static_cast<std::size_t>(rows_));
    parallel_rows(rows_, 1, threads_, [&](int first, int last, int) {
      for (int j = first; j < last; ++j) {
        BlockShift* const row = blocks.data() + static_cast<std::size_t>(j) * columns;
        for (int i = 0; i < columns_; ++i) {
          measure_block(plane, i * block_size + half_block, j * block_size + half_block, row[i]);
        }
      }
    });
    return blocks;
  }

 private:
  void measure_block(const DisparityPlane& plane, int u, int v, BlockShift& block) const {
    block.u = u;
    block.v = v;
    if (masked_.contains(u, v, half_block, half_block) || !is_seen(plane, u, v)) return;
    AlignmentSums<float> sums{};
    const int first = u - half_block;
    const float level = left_.row(v)[u];  // keeps digits
    const auto step = static_cast<float>(1 - plane.a2);
    for (int y = v - half_block; y <= v + half_block; ++y) {
      const float *const left = left_.row(y) + first, *const right = right_.row(y);
      const auto begin = static_cast<float>(first - plane.disparity(first, y));
      for (int k = 0; k < block_size; ++k) {
        const float x = begin + static_cast<float>(k) * step;
        const int whole = static_cast<int>(x);
        const float f = x - static_cast<float>(whole);
        const float* const at = right + whole;
        const float value = at[0] + f * (at[1] - at[0]);
        const float gradient = 0.5F * ((1 - f) * (at[1] - at[-1]) + f * (at[2] - at[0]));
        sums.add({1, value - level, gradient, left[k] - value});
      }
    }
    solve_block(sums, block);
  }

  /// Whether a block lies below the horizon, and what it reads along the plane in the right image.
  bool is_seen(const DisparityPlane& plane, int u, int v) const {
    constexpr double rounding = 0.01, before = 1 + rounding, behind = 2 + rounding;  // pixels read beside a place
    for (const int y : {v - half_block, v + half_block}) {
      for (const int x : {u - half_block, u + half_block}) {
        const double d = plane.disparity(x, y);
        if (!(d > 0 && x - d >= before && x - d <= right_.width() - 1 - behind)) return false;
      }
    }
    return true;
  }

  SmoothImage left_, right_;
  MaskedBlocks masked_;
  int columns_, rows_;
  int threads_;
};

/// Weight of a block in the fit: its information beside that of a road that is no plane, 0 beyond what such a road
/// deviates.
double weight_of(const BlockShift& block) {
  constexpr double road_px = 0.02, min_correlation = 0.3;
  if (block.correlation < min_correlation) return 0;
  const double variance = block.variance + road_px * road_px;
  return tukey_weight(block.shift / (tukey * std::sqrt(variance))) / variance;
}

}  // namespace

DisparityPlane align_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                           ImageView<const std::uint8_t> mask, const DisparityPlane& plane, int factor, bool with_roll,
                           int threads) {
  constexpr int iterations = 8;
  constexpr double enough_px = 0.01, smallest = 1e-9;
  const PlaneAlignment alignment(left, right, mask, factor, threads);
  DisparityPlane aligned = downsample_plane(plane, factor);
  for (int k = 0; k < iterations; ++k) {
    Matrix<3> matrix{};
    Vector<3> right_side{};
    for (const BlockShift& block : alignment.measure(aligned)) {
      const double weight = weight_of(block);
      const Vector<3> terms{1, block.v, with_roll ? block.u : 0};
      for (std::size_t a = 0; a < terms.size(); ++a) {
        right_side[a] += weight * terms[a] * block.shift;
        for (std::size_t b = 0; b <= a; ++b) matrix[a][b] += weight * terms[a] * terms[b];
      }
    }
    if (!with_roll) matrix[2][2] = 1;
    const std::optional<Vector<3>> change = solve_positive_definite(matrix, right_side, smallest);
    if (!change) return plane;
    const auto& [a0, a1, a2] = *change;
    aligned = {aligned.a0 + a0, aligned.a1 + a1, aligned.a2 + a2};
    const double most = std::abs(a0) + std::abs(a1) * alignment.height() + std::abs(a2) * alignment.width();
    if (most < enough_px) break;
  }
  return plane_to_full_size(aligned, factor);
}

}  // namespace roadstereo

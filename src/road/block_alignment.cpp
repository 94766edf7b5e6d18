#include "road/block_alignment.hpp"

#include <array>
#include <cmath>

namespace roadstereo {
namespace {

constexpr std::size_t parameters = 6;  // du, dv, shear, stretch, gain, offset
using Vector = std::array<double, parameters>;
using Matrix = std::array<Vector, parameters>;

/// Solves a x = b for a symmetric positive definite matrix by its Cholesky factor; nothing when it is not one.
std::optional<Vector> solve(Matrix a, Vector b) {
  constexpr double smallest = 1e-12;
  for (std::size_t k = 0; k < parameters; ++k) {
    const double size = a[k][k];
    for (std::size_t j = 0; j < k; ++j) a[k][k] -= a[k][j] * a[k][j];
    if (!(a[k][k] > smallest * size)) return std::nullopt;
    a[k][k] = std::sqrt(a[k][k]);
    for (std::size_t i = k + 1; i < parameters; ++i) {
      for (std::size_t j = 0; j < k; ++j) a[i][k] -= a[i][j] * a[k][j];
      a[i][k] /= a[k][k];
    }
  }
  for (std::size_t k = 0; k < parameters; ++k) {
    for (std::size_t j = 0; j < k; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  for (std::size_t k = parameters; k-- > 0;) {
    for (std::size_t i = k + 1; i < parameters; ++i) b[k] -= a[i][k] * b[i];
    b[k] /= a[k][k];
  }
  return b;
}

/// Grey value (8-bit scale) and gradient between the pixels.
struct Sample {
  double grey, across, down;
};

Sample sample(ImageView<const std::int16_t> image, double u, double v) {
  const double whole_u = std::floor(u), whole_v = std::floor(v);
  const double f = u - whole_u, g = v - whole_v;
  const std::int16_t* above = image.row(static_cast<int>(whole_v)) + static_cast<std::ptrdiff_t>(whole_u);
  const std::int16_t* below = above + image.stride();
  const double top = above[0] + f * (above[1] - above[0]), bottom = below[0] + f * (below[1] - below[0]);
  constexpr double unit = 1.0 / grey_scale;
  return {.grey = unit * (top + g * (bottom - top)),
          .across = unit * ((1 - g) * (above[1] - above[0]) + g * (below[1] - below[0])),
          .down = unit * (bottom - top)};
}

/// The normal equations of one step, and how well the blocks correlate at its start.
struct Equations {
  Matrix a{};
  Vector b{};
  double correlation = 0;
};

std::optional<Equations> set_up(ImageView<const std::int16_t> left, int u, int v, ImageView<const std::int16_t> right,
                                const Vector& p, int radius) {
  Equations e;
  double n = 0, sl = 0, sr = 0, ll = 0, rr = 0, lr = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const double at_u = u + x + p[0] + p[2] * y + p[3] * x, at_v = v + y + p[1];
      if (!(at_u >= 0 && at_v >= 0 && at_u < right.width() - 1 && at_v < right.height() - 1)) return std::nullopt;
      const Sample s = sample(right, at_u, at_v);
      const double grey = static_cast<double>(left(u + x, v + y)) / grey_scale;
      const Vector slope{p[4] * s.across, p[4] * s.down, p[4] * s.across * y, p[4] * s.across * x, s.grey, 1.0};
      const double residual = grey - p[4] * s.grey - p[5];
      for (std::size_t i = 0; i < parameters; ++i) {
        e.b[i] += slope[i] * residual;
        for (std::size_t j = 0; j <= i; ++j) e.a[i][j] += slope[i] * slope[j];
      }
      n += 1;
      sl += grey;
      sr += s.grey;
      ll += grey * grey;
      rr += s.grey * s.grey;
      lr += grey * s.grey;
    }
  }
  const double variances = (n * ll - sl * sl) * (n * rr - sr * sr);
  e.correlation = variances > 0 ? (n * lr - sl * sr) / std::sqrt(variances) : 0;
  return e;
}

}  // namespace

std::optional<BlockAlignment> align_block(ImageView<const std::int16_t> left, int u, int v,
                                          ImageView<const std::int16_t> right, const BlockAlignment& start,
                                          int radius) {
  constexpr int most_steps = 12;
  constexpr double converged_px = 0.01;
  constexpr double farthest_px = 1.5;
  constexpr double least_correlation = 0.85;
  if (u < radius || v < radius || u + radius >= left.width() || v + radius >= left.height()) return std::nullopt;
  Vector p{start.du, start.dv, start.shear, start.stretch, 1, 0};
  for (int step = 0; step < most_steps; ++step) {
    const auto equations = set_up(left, u, v, right, p, radius);
    if (!equations) return std::nullopt;
    const auto change = solve(equations->a, equations->b);
    if (!change) return std::nullopt;
    for (std::size_t i = 0; i < parameters; ++i) p[i] += (*change)[i];
    if (std::abs(p[0] - start.du) > farthest_px || std::abs(p[1] - start.dv) > farthest_px) return std::nullopt;
    if (std::max(std::abs((*change)[0]), std::abs((*change)[1])) > converged_px) continue;
    if (equations->correlation < least_correlation) return std::nullopt;
    return BlockAlignment{p[0], p[1], p[2], p[3]};
  }
  return std::nullopt;
}

}  // namespace roadstereo

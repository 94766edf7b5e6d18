#include "road/block_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cholesky.hpp"
#include "road/cubic.hpp"

namespace roadstereo {
namespace {

constexpr std::size_t parameters = 6;  // du, dv, shear, stretch, gain, offset
using Parameters = Vector<parameters>;
constexpr double min_share = 1e-5;  // sums of single precision leave that much of nothing

constexpr int max_radius = 8;
constexpr std::size_t columns = 20;  ///< of the largest block, up to whole vectors of four
using Columns = std::array<float, columns>;

/// One row of the block as the right image shows it where it is supposed to lie: grey levels (8-bit scale, minus the
/// left block's mean), their gradients, and what gain and offset leave of the left image. Columns behind the block are
/// 0.
struct Row {
  Columns grey{}, across{}, down{}, residual{};
};

/// Sums over the columns' pixels of products of the two that they are named after, and those weighted by the row y or
/// its square. The columns are added up last: a column's own coordinate is a factor of all its pixels.
struct ColumnSums {
  Columns aa{}, ad{}, dd{}, ag{}, dg{}, gg{}, a{}, d{}, g{}, ar{}, dr{}, gr{}, r{};
  Columns y_aa{}, yy_aa{}, y_ad{}, y_ag{}, y_a{}, y_ar{};

  void add(const Row& row, float y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const float across = row.across[x], down = row.down[x], grey = row.grey[x], residual = row.residual[x];
      aa[x] += across * across;
      ad[x] += across * down;
      ag[x] += across * grey;
      a[x] += across;
      ar[x] += across * residual;
      y_aa[x] += y * across * across;
      yy_aa[x] += y * y * across * across;
      y_ad[x] += y * across * down;
      y_ag[x] += y * across * grey;
      y_a[x] += y * across;
      y_ar[x] += y * across * residual;
    }
    for (std::size_t x = 0; x < columns; ++x) {
      const float down = row.down[x], grey = row.grey[x], residual = row.residual[x];
      dd[x] += down * down;
      dg[x] += down * grey;
      gg[x] += grey * grey;
      d[x] += down;
      g[x] += grey;
      dr[x] += down * residual;
      gr[x] += grey * residual;
      r[x] += residual;
    }
  }
};

/// The block of the left image: grey levels (8-bit scale) without their mean.
class LeftBlock {
 public:
  LeftBlock(ImageView<const std::int16_t> image, int u, int v, int radius) : u_(u), v_(v), radius_(radius) {
    double sum = 0;
    for_pixels(image, [&](std::size_t, std::size_t, double grey) { sum += grey; });
    mean_ = sum / pixels();
    for_pixels(image, [&](std::size_t x, std::size_t y, double grey) {
      rows_[y][x] = static_cast<float>(grey - mean_);
      squares_ += (grey - mean_) * (grey - mean_);
    });
  }

  int u() const { return u_; }
  int v() const { return v_; }
  int radius() const { return radius_; }
  int width() const { return 2 * radius_ + 1; }
  double pixels() const { return static_cast<double>(width()) * width(); }
  double mean() const { return mean_; }
  double squares() const { return squares_; }
  /// Row y, counted from the centre.
  const Columns& row(int y) const { return *(rows_.data() + radius_ + y); }

 private:
  template <class Visitor>
  void for_pixels(ImageView<const std::int16_t> image, const Visitor& visit) const {
    for (int y = 0; y < width(); ++y) {
      const std::int16_t* row = image.row(v_ + y - radius_) + u_ - radius_;
      for (int x = 0; x < width(); ++x) {
        visit(static_cast<std::size_t>(x), static_cast<std::size_t>(y), static_cast<double>(row[x]) / grey_scale);
      }
    }
  }

  int u_, v_, radius_;
  double mean_ = 0, squares_ = 0;
  std::array<Columns, 2 * max_radius + 1> rows_{};
};

/// Row y of the block in the right image under the parameters p; false when it leaves the image.
bool sample_row(ImageView<const std::int16_t> right, const LeftBlock& block, const Parameters& p, int y, Row& row) {
  const double at_v = block.v() + y + p[1], step = 1 + p[3];
  const double start = block.u() - block.radius() * step + p[0] + p[2] * y, end = start + (block.width() - 1) * step;
  if (!(at_v >= 1 && at_v < right.height() - 2 && std::min(start, end) >= 0 &&
        std::max(start, end) < right.width() - 1))
    return false;
  const int whole_v = static_cast<int>(at_v);
  const auto low = static_cast<float>(at_v - whole_v), mean = static_cast<float>(block.mean());
  const CubicWeights weights = cubic_weights(low);
  const std::int16_t *before = right.row(whole_v - 1), *above = right.row(whole_v);
  const std::int16_t *below = right.row(whole_v + 1), *beyond = right.row(whole_v + 2);
  constexpr float unit = 1.0f / grey_scale;
  for (int x = 0; x < block.width(); ++x) {
    const double at_u = start + x * step;
    const int whole_u = static_cast<int>(at_u);
    const auto f = static_cast<float>(at_u - whole_u);
    const auto across_above = static_cast<float>(above[whole_u + 1] - above[whole_u]);
    const auto across_below = static_cast<float>(below[whole_u + 1] - below[whole_u]);
    const auto between = [whole_u, f](const std::int16_t* from) {
      return static_cast<float>(from[whole_u]) + f * static_cast<float>(from[whole_u + 1] - from[whole_u]);
    };
    const float top = between(above), bottom = between(below);
    const auto i = static_cast<std::size_t>(x);
    // Linear interpolation blurs between two rows and not on one, which would draw the block towards whole rows.
    row.grey[i] = unit * weighted(weights, between(before), top, bottom, between(beyond)) - mean;
    row.across[i] = unit * (across_above + low * (across_below - across_above));
    row.down[i] = unit * (bottom - top);
    row.residual[i] = block.row(y)[i] - static_cast<float>(p[4]) * row.grey[i] - static_cast<float>(p[5]);
  }
  return true;
}

/// The normal equations of one step, and how well the blocks correlate at its start.
struct Equations {
  Matrix<parameters> a{};
  Parameters b{};
  double correlation = 0;
};

double total(const Columns& sums) {
  double sum = 0;
  for (const float value : sums) sum += double{value};
  return sum;
}

/// Sums weighted by the column's coordinate x, or by its square.
double moment(const Columns& sums, int radius, int power) {
  double sum = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const double x = static_cast<double>(i) - radius;
    sum += double{sums[i]} * (power == 1 ? x : x * x);
  }
  return sum;
}

/// Slopes of the residual: gain·a, gain·d, gain·a·y, gain·a·x, g, 1.
Equations make_equations(const ColumnSums& s, const LeftBlock& block, const Parameters& p) {
  const double gain = p[4], offset = p[5], n = block.pixels();
  const int radius = block.radius();
  const auto x = [radius](const Columns& sums) { return moment(sums, radius, 1); };
  Equations e;
  e.a[0][0] = gain * gain * total(s.aa);
  e.a[1] = {gain * gain * total(s.ad), gain * gain * total(s.dd)};
  e.a[2] = {gain * gain * total(s.y_aa), gain * gain * total(s.y_ad), gain * gain * total(s.yy_aa)};
  e.a[3] = {gain * gain * x(s.aa), gain * gain * x(s.ad), gain * gain * x(s.y_aa),
            gain * gain * moment(s.aa, radius, 2)};
  e.a[4] = {gain * total(s.ag), gain * total(s.dg), gain * total(s.y_ag), gain * x(s.ag), total(s.gg)};
  e.a[5] = {gain * total(s.a), gain * total(s.d), gain * total(s.y_a), gain * x(s.a), total(s.g), n};
  e.b = {gain * total(s.ar), gain * total(s.dr), gain * total(s.y_ar), gain * x(s.ar), total(s.gr), total(s.r)};
  // left = residual + gain·g + offset
  const double sum = total(s.g), squares = total(s.gg);
  const double products = total(s.gr) + gain * squares + offset * sum;
  const double variances = block.squares() * (squares - sum * sum / n);
  e.correlation = variances > 0 ? products / std::sqrt(variances) : 0;
  return e;
}

std::optional<Equations> set_up(const LeftBlock& block, ImageView<const std::int16_t> right, const Parameters& p) {
  ColumnSums sums;
  Row row;
  for (int y = -block.radius(); y <= block.radius(); ++y) {
    if (!sample_row(right, block, p, y, row)) return std::nullopt;
    sums.add(row, static_cast<float>(y));
  }
  return make_equations(sums, block, p);
}

}  // namespace

std::optional<BlockAlignment> affine_lucas_kanade(ImageView<const std::int16_t> left, int u, int v,
                                                  ImageView<const std::int16_t> right, const BlockAlignment& start,
                                                  int radius) {
  constexpr int max_steps = 12;
  constexpr double converged_px = 0.01;
  constexpr double farthest_px = 1.5;
  constexpr double min_correlation = 0.85;
  if (u < radius || v < radius || u + radius >= left.width() || v + radius >= left.height()) return std::nullopt;
  const LeftBlock block(left, u, v, radius);
  Parameters p{start.du, start.dv, start.shear, start.stretch, 1, 0};
  for (int step = 0; step < max_steps; ++step) {
    const auto equations = set_up(block, right, p);
    if (!equations) return std::nullopt;
    const auto change = solve_positive_definite(equations->a, equations->b, min_share);
    if (!change) return std::nullopt;
    for (std::size_t i = 0; i < parameters; ++i) p[i] += (*change)[i];
    if (std::abs(p[0] - start.du) > farthest_px || std::abs(p[1] - start.dv) > farthest_px) return std::nullopt;
    if (std::max(std::abs((*change)[0]), std::abs((*change)[1])) > converged_px) continue;
    if (equations->correlation < min_correlation) return std::nullopt;
    return BlockAlignment{p[0], p[1], p[2], p[3]};
  }
  return std::nullopt;
}

}  // namespace roadstereo

#include "road/block_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cholesky.hpp"
#include "road/cubic.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/block_alignment.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace {

using Floats = hn::CappedTag<float, 8>;
using Float = hn::Vec<Floats>;

constexpr std::size_t parameters = 6;  // du, dv, shear, stretch, gain, offset
using Parameters = Vector<parameters>;
constexpr double min_share = 1e-5;  // sums of single precision leave that much of nothing

constexpr int max_radius = 8;
constexpr std::size_t columns = 24;  ///< of the largest block, up to whole vectors of eight
using Columns = std::array<float, columns>;

/// One row of the block as the right image shows it where it is supposed to lie: grey levels (8-bit scale, minus the
/// left block's mean), their gradients, and what gain and offset leave of the left image. Columns behind the block are
/// 0.
struct Row {
  Columns grey{}, across{}, down{}, residual{};
};

/// Sums over the columns' pixels of products of the two that they are named after, and those weighted by the row y or
/// its square. The columns are added up last: a column's own coordinate is a factor of all its pixels.
struct BlockSums {
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

/// A row between those of the right image, from a column on: grey levels and their slopes. The last column that was
/// read is there twice; what lies beside is finite.
class BetweenRows {
 public:
  static constexpr int margin = 10;  ///< a block of 17 pixels that is stretched by half is so much wider

  void read(ImageView<const std::int16_t> right, int first, int count, int v, float low) {
    constexpr float unit = 1.0f / grey_scale;
    const CubicWeights weights = cubic_weights(low), slopes = cubic_slope_weights(low);
    const std::int16_t *const before = right.row(v - 1) + first, *const at = right.row(v) + first;
    const std::int16_t *const after = right.row(v + 1) + first, *const beyond = right.row(v + 2) + first;
    float *HWY_RESTRICT grey = grey_.data() + margin, *HWY_RESTRICT down = down_.data() + margin;
    float *HWY_RESTRICT linear = linear_.data() + margin, *HWY_RESTRICT across = across_.data() + margin;
    for (int i = 0; i < count; ++i) {
      const auto above = static_cast<float>(before[i]), below = static_cast<float>(beyond[i]);
      const auto top = static_cast<float>(at[i]), bottom = static_cast<float>(after[i]);
      // Linear interpolation blurs between two rows and not on one, which would draw the block towards whole rows.
      grey[i] = unit * weighted(weights, above, top, bottom, below);
      linear[i] = unit * (top + low * (bottom - top));
      down[i] = unit * weighted(slopes, above, top, bottom, below);
    }
    // Slopes are those at the place itself: half a pixel off they are correlated with the noise of the residual.
    for (int i = 1; i + 1 < count; ++i) across[i] = 0.5F * (linear[i + 1] - linear[i - 1]);
    across[0] = linear[1] - linear[0];
    across[count - 1] = linear[count - 1] - linear[count - 2];
    for (float* const values : {grey, down, across}) values[count] = values[count - 1];
  }
  /// At column i + offset.
  const float* grey(int offset) const { return grey_.data() + margin + offset; }
  const float* across(int offset) const { return across_.data() + margin + offset; }
  const float* down(int offset) const { return down_.data() + margin + offset; }

 private:
  static constexpr std::size_t capacity = columns + std::size_t{2} * margin + 2;
  std::array<float, capacity> grey_{}, down_{}, across_{}, linear_{};
};

/// Adds what the columns i + offset and i + offset + 1 of a row give to pixel i of the block, which lies at column
/// i + slide + i·stretch: linear interpolation as a sum over offsets, so that nothing is looked up.
HWY_INLINE void add_columns(const BetweenRows& between, int offset, float slide, float stretch, Row& row) {
  const Floats df;
  const Float zero = hn::Zero(df), one = hn::Set(df, 1.0F), here = hn::Set(df, static_cast<float>(offset));
  const auto add = [df](float* to, Float value) { hn::StoreU(hn::Add(hn::LoadU(df, to), value), df, to); };
  for (std::size_t i = 0; i < columns; i += hn::Lanes(df)) {
    const Float place = hn::MulAdd(hn::Iota(df, static_cast<float>(i)), hn::Set(df, stretch), hn::Set(df, slide));
    const Float weight = hn::Max(zero, hn::Sub(one, hn::Abs(hn::Sub(place, here))));
    add(row.grey.data() + i, hn::Mul(weight, hn::LoadU(df, between.grey(offset) + i)));
    add(row.down.data() + i, hn::Mul(weight, hn::LoadU(df, between.down(offset) + i)));
    add(row.across.data() + i, hn::Mul(weight, hn::LoadU(df, between.across(offset) + i)));
  }
}

/// Row y of the block in the right image under the parameters p; false when it leaves the image, or is stretched by
/// more than half. `between` is scratch memory.
bool sample_row(ImageView<const std::int16_t> right, const LeftBlock& block, const Parameters& p, int y,
                BetweenRows& between, Row& row) {
  constexpr double max_stretch = 0.5;
  const double at_v = block.v() + y + p[1], step = 1 + p[3];
  const double start = block.u() - block.radius() * step + p[0] + p[2] * y, end = start + (block.width() - 1) * step;
  if (!(std::abs(p[3]) <= max_stretch && at_v >= 1 && at_v < right.height() - 2 && start >= 0 &&
        end < right.width() - 1))
    return false;
  // A column more on either side, for the slopes.
  const int v = static_cast<int>(at_v), first = std::max(0, static_cast<int>(start) - 1);
  const int behind = std::min(right.width(), static_cast<int>(end) + 3);
  between.read(right, first, behind - first, v, static_cast<float>(at_v - v));
  const auto slide = static_cast<float>(start - first), stretch = static_cast<float>(p[3]);
  const float last = slide + static_cast<float>(block.width() - 1) * stretch;
  row = {};
  constexpr float rounding = 1e-5F;  // of the places in add_columns
  const int lowest = static_cast<int>(std::floor(std::min(slide, last) - rounding));
  const int highest = static_cast<int>(std::floor(std::max(slide, last) + rounding)) + 1;
  for (int k = lowest; k <= highest; ++k) add_columns(between, k, slide, stretch, row);
  const auto mean = static_cast<float>(block.mean()), gain = static_cast<float>(p[4]),
             offset = static_cast<float>(p[5]);
  const Columns& left = block.row(y);
  for (std::size_t i = 0; i < columns; ++i) {
    const float inside = static_cast<int>(i) < block.width() ? 1.0F : 0.0F;
    row.grey[i] = inside * (row.grey[i] - mean);
    row.across[i] *= inside;
    row.down[i] *= inside;
    row.residual[i] = inside * (left[i] - gain * row.grey[i] - offset);
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
Equations make_equations(const BlockSums& s, const LeftBlock& block, const Parameters& p) {
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
  BlockSums sums;
  BetweenRows between;
  Row row;
  for (int y = -block.radius(); y <= block.radius(); ++y) {
    if (!sample_row(right, block, p, y, between, row)) return std::nullopt;
    sums.add(row, static_cast<float>(y));
  }
  return make_equations(sums, block, p);
}

}  // namespace

std::optional<BlockAlignment> align_block(ImageView<const std::int16_t> left, int u, int v,
                                          ImageView<const std::int16_t> right, const BlockAlignment& start,
                                          int radius) {
  constexpr int max_steps = 24;
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

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(align_block);

std::optional<BlockAlignment> affine_lucas_kanade(ImageView<const std::int16_t> left, int u, int v,
                                                  ImageView<const std::int16_t> right, const BlockAlignment& start,
                                                  int radius) {
  return HWY_DYNAMIC_DISPATCH(align_block)(left, u, v, right, start, radius);
}

}  // namespace roadstereo
#endif  // HWY_ONCE

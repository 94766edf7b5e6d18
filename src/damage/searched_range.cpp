#include "damage/searched_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "damage/block_votes.hpp"
#include "damage/likelihood_vote.hpp"
#include "damage/rectified_right_image.hpp"
#include "damage/sampling_step.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "damage/searched_range.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// For each k add Σ r[k + j], Σ r[k + j]² and Σ l[j]·r[k + j]. The loop over k is vectorised.
void add_row_sums(std::span<const float> left, std::span<const float> right, std::span<float> b, std::span<float> bb,
                  std::span<float> ab) {
  const std::size_t count = b.size();
  for (std::size_t j = 0; j < left.size(); ++j) {
    const float l = left[j];
    const float* const r = right.data() + j;
    float *const sum = b.data(), *const square = bb.data(), *const product = ab.data();
    for (std::size_t k = 0; k < count; ++k) {
      sum[k] += r[k];
      square[k] += r[k] * r[k];
      product[k] += l * r[k];
    }
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {
namespace {

HWY_EXPORT(add_row_sums);

constexpr int window_radius = 7, window_side = 2 * window_radius + 1;
constexpr std::size_t window_pixels = std::size_t{window_side} * window_side;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// Sums over a window; grey levels relative to its centre.
struct WindowSums {
  float n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(float left, float right) {
    n += 1;
    a += left;
    b += right;
    aa += left * left;
    bb += right * right;
    ab += left * right;
  }
  /// ZNCC, 0 if negative; NaN if the window has no more contrast than rounding gives it.
  float zncc() const {
    const float one = aa - a * a / n, other = bb - b * b / n;
    const bool has_contrast = one > n / 12 && other > n / 12;  // 1/12: variance of rounding
    return has_contrast ? std::max(0.0F, (ab - a * b / n) / std::sqrt(one * other)) : unknown;
  }
};

/// Compares the measured disparities of windows with those that were not searched.
class RangeVote {
 public:
  explicit RangeVote(const DamageInput& input)
      : input_(input), shift_(*input.shift), right_(input.right, shift_.misalignment) {}

  /// Vote of the window around (u, v) for the measured disparities; nothing if it is not inside the picture or has no
  /// contrast along either.
  std::optional<float> at(int u, int v) {
    const int width = input_.grey.width(), height = input_.grey.height();
    const bool inside =
        u >= window_radius && v >= window_radius && u + window_radius < width && v + window_radius < height;
    if (!inside) return {};
    set_range(u, v);
    WindowSums measured;
    float a = 0, aa = 0;
    for (int y = v - window_radius; y <= v + window_radius; ++y) {
      read_row(u, v, y);
      for (const float left : left_) {
        a += left;
        aa += left * left;
      }
      HWY_DYNAMIC_DISPATCH(add_row_sums)(left_, line_, b_, bb_, ab_);
      add_measured(u, v, y, measured);
    }
    if (2 * measured.n < static_cast<float>(window_pixels)) return {};
    float best = unknown;
    for (std::size_t k = 0; k < b_.size(); ++k) {
      const int residual = largest_ - static_cast<int>(k);
      if (residual >= -1 && residual <= shift_.disparities) continue;  // searched, or beside that
      const WindowSums sums{static_cast<float>(window_pixels), a, b_[k], aa, bb_[k], ab_[k]};
      best = std::fmax(best, sums.zncc());
    }
    const float along_measured = measured.zncc();
    if (std::isnan(along_measured) || std::isnan(best)) return {};
    return likelihood_vote(along_measured, best, window_pixels);
  }

 private:
  /// Residual disparities from infinity to half of the distance of the road at (u, v), the largest first.
  void set_range(int u, int v) {
    const double at_infinity = -shift_.disparity_offset_px, shift = shift_.at(u, v);
    const double nearest = 2 * (shift_.road.disparity(u, v) - at_infinity) + at_infinity;
    largest_ = std::max(static_cast<int>(nearest - shift), shift_.disparities + 1);
    const int smallest = std::min(static_cast<int>(at_infinity - shift), -2);
    const auto count = static_cast<std::size_t>(largest_ - smallest) + 1;
    for (auto* sums : {&b_, &bb_, &ab_}) sums->assign(count, 0.0F);
    line_.resize(count + window_side - 1);
  }

  /// Row y of the window around (u, v), and the right image at the columns of its first pixel at the largest residual
  /// to its last at the smallest.
  void read_row(int u, int v, int y) {
    const float centre = input_.grey(u, v);
    for (int x = 0; x < window_side; ++x) {
      left_[static_cast<std::size_t>(x)] = static_cast<float>(input_.grey(u - window_radius + x, y)) - centre;
    }
    const double shift = shift_.at(u, y), first = u - window_radius - shift - largest_;
    right_.read(first, y, right_.row(u - shift, y), line_);
    for (float& right : line_) right -= centre;
  }

  void add_measured(int u, int v, int y, WindowSums& sums) const {
    const float centre = input_.grey(u, v);
    const float* const disparity = input_.disparity_in_images().row(y);
    for (int x = u - window_radius; x <= u + window_radius; ++x) {
      const double at = x - double{disparity[x]};
      if (!std::isfinite(at)) continue;
      const float right = right_(at, y, right_.row(at, y)) - centre;
      if (!std::isnan(right)) sums.add(static_cast<float>(input_.grey(x, y)) - centre, right);
    }
  }

  const DamageInput& input_;
  const PerspectiveShift& shift_;
  RectifiedRightImage right_;
  int largest_ = 0;  ///< residual disparity
  std::array<float, window_side> left_{};
  std::vector<float> line_, b_, bb_, ab_;
};

}  // namespace

double range_vote(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box) {
  constexpr double max_windows = 64;
  constexpr int min_step = 4;
  if (!has_blocks(input) || !input.shift) return double{unknown};
  const int step = sampling_step(box, max_windows, min_step);
  RangeVote vote(input);
  double votes = 0, windows = 0;
  for (int v = box.v0; v <= box.v1; v += step) {
    for (int u = box.u0; u <= box.u1; u += step) {
      if (maps.ids(u, v) != id || !std::isfinite(input.disparity(u, v))) continue;
      const std::optional<float> of_window = vote.at(u, v);
      if (!of_window) continue;
      votes += double{*of_window};
      ++windows;
    }
  }
  return windows > 0 ? votes / windows : double{unknown};
}

}  // namespace roadstereo
#endif  // HWY_ONCE

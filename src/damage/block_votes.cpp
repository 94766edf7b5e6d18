#include "damage/block_votes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "damage/likelihood_vote.hpp"
#include "road/cubic.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "damage/block_votes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// Blocks that are compared together, one value of each: loops over them are vectorised.
constexpr std::size_t max_lanes = 32;
template <class Value>
using Lanes = std::array<Value, max_lanes>;
using Blocks = std::array<Lanes<float>, block_pixels>;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// ZNCC, 0 if negative; NaN if a value is NaN or a block has no more contrast than rounding gives it.
void correlate(const Blocks& one, const Blocks& other, std::size_t lanes, Lanes<float>& result) {
  Lanes<float> a{}, b{}, aa{}, bb{}, ab{};
  for (std::size_t k = 0; k < block_pixels; ++k) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const float x = one[k][l] - one[block_pixels / 2][l],
                  y = other[k][l] - other[block_pixels / 2][l];  // keeps digits
      a[l] += x;
      b[l] += y;
      aa[l] += x * x;
      bb[l] += y * y;
      ab[l] += x * y;
    }
  }
  constexpr float n = static_cast<float>(block_pixels);
  for (std::size_t l = 0; l < lanes; ++l) {
    const float one_sum = aa[l] - a[l] * a[l] / n, other_sum = bb[l] - b[l] * b[l] / n;
    const float zncc = std::max(0.0F, (ab[l] - a[l] * b[l] / n) / std::sqrt(one_sum * other_sum));
    result[l] = one_sum > n / 12 && other_sum > n / 12 ? zncc : unknown;  // 1/12: variance of rounding
  }
}

/// Two neighbouring pixels of a row, loaded at once.
using PixelPair = std::int32_t;

float left_of(PixelPair pair) {
  return static_cast<float>(std::endian::native == std::endian::little ? pair << 16 >> 16 : pair >> 16);
}
float right_of(PixelPair pair) {
  return static_cast<float>(std::endian::native == std::endian::little ? pair >> 16 : pair << 16 >> 16);
}

/// Places in one axis: the pixel before each and the weights of the four pixels from the one before that on.
struct Places {
  Lanes<int> first;
  Lanes<float> before, at, after, beyond;

  void set(std::size_t lane, int pixel, float offset) {
    const CubicWeights weight = cubic_weights(offset);
    first[lane] = pixel;
    before[lane] = weight.before;
    at[lane] = weight.at;
    after[lane] = weight.after;
    beyond[lane] = weight.beyond;
  }
  CubicWeights weight(std::size_t lane) const { return {before[lane], at[lane], after[lane], beyond[lane]}; }
};

/// A row of the right image, but for its misalignment.
class RightRow {
 public:
  RightRow(const DamageInput& input, int v)
      : image_(input.right),
        misalignment_(input.shift ? input.shift->misalignment : Misalignment{}),
        v_(v),
        is_aligned_(misalignment_.is_zero()) {}

  /// Columns x; NaN outside.
  void read(const Lanes<float>& x, std::size_t lanes, Lanes<float>& values) const {
    const auto end = static_cast<float>(image_.width() - 2);
    const double turned = misalignment_.columns_at(v_);
    Places columns;
    Lanes<float> inside_x, outside;
    for (std::size_t l = 0; l < lanes; ++l) {
      const auto column = static_cast<float>(double{x[l]} + turned);
      const bool inside = column >= 1 && column < end;
      const float safe = inside ? column : 1.0F;
      const int whole = static_cast<int>(safe);
      columns.set(l, whole, safe - static_cast<float>(whole));
      inside_x[l] = inside ? x[l] : 1.0F;
      outside[l] = inside ? 0.0F : unknown;
    }
    is_aligned_ ? read_aligned(columns, lanes, values) : read_between(columns, inside_x, lanes, outside, values);
    for (std::size_t l = 0; l < lanes; ++l) values[l] += outside[l];
  }

 private:
  /// Pixels of a row around places, as pairs: before and at, after and beyond.
  struct RowPixels {
    Lanes<PixelPair> left, right;

    void load(std::size_t lane, const std::int16_t* pixel) {
      std::memcpy(&left[lane], pixel - 1, sizeof(PixelPair));
      std::memcpy(&right[lane], pixel + 1, sizeof(PixelPair));
    }
    float at(const Places& columns, std::size_t lane) const {
      return weighted(columns.weight(lane), left_of(left[lane]), right_of(left[lane]), left_of(right[lane]),
                      right_of(right[lane]));
    }
  };

  void read_aligned(const Places& columns, std::size_t lanes, Lanes<float>& values) const {
    RowPixels pixels;
    for (std::size_t l = 0; l < lanes; ++l) pixels.load(l, image_.row(v_) + columns.first[l]);
    for (std::size_t l = 0; l < lanes; ++l) values[l] = pixels.at(columns, l);
  }

  /// Between the rows where the misalignment has moved the columns x.
  void read_between(const Places& columns, const Lanes<float>& x, std::size_t lanes, Lanes<float>& outside,
                    Lanes<float>& values) const {
    const int last_row = image_.height() - 3;
    Places rows;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double row = v_ + misalignment_.rows_at(double{x[l]}, v_);
      const int truncated = static_cast<int>(row);
      const int whole = row < truncated ? truncated - 1 : truncated;
      const bool inside = whole >= 1 && whole <= last_row;
      rows.set(l, inside ? whole : 1, static_cast<float>(row - whole));
      outside[l] = inside ? outside[l] : unknown;
    }
    RowPixels before, at, after, beyond;
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::int16_t* const pixel = image_.row(rows.first[l]) + columns.first[l];
      before.load(l, pixel - image_.stride());
      at.load(l, pixel);
      after.load(l, pixel + image_.stride());
      beyond.load(l, pixel + 2 * image_.stride());
    }
    for (std::size_t l = 0; l < lanes; ++l) {
      values[l] = weighted(rows.weight(l), before.at(columns, l), at.at(columns, l), after.at(columns, l),
                           beyond.at(columns, l));
    }
  }

  ImageView<const std::int16_t> image_;
  Misalignment misalignment_;
  int v_;
  bool is_aligned_;
};

/// Votes of the blocks from `first` on, up to as many as are compared together.
void vote_lanes(const DamageInput& input, int v, std::span<const int> u, std::span<const float> surface,
                std::size_t first, std::span<float> votes) {
  const int width = input.grey.width();
  const std::size_t lanes = std::min(u.size() - first, max_lanes);
  Lanes<int> column;
  Lanes<float> road_surface;
  for (std::size_t l = 0; l < lanes; ++l) {
    column[l] = std::clamp(u[first + l], block_radius, width - 1 - block_radius);
    road_surface[l] = surface[first + l];
  }
  Blocks left, measured, road;
  std::size_t k = 0;
  for (int y = v - block_radius; y <= v + block_radius; ++y) {
    const RightRow row(input, y);
    const std::int16_t* const grey = input.grey.row(y);
    const float *const disparity = input.disparity_in_images().row(y), *const transformed = input.transformed.row(y);
    for (int x = -block_radius; x <= block_radius; ++x, ++k) {
      Lanes<float> disparities, transforms, at, at_road;
      for (std::size_t l = 0; l < lanes; ++l) {
        const int pixel = column[l] + x;
        left[k][l] = grey[pixel];
        disparities[l] = disparity[pixel];
        transforms[l] = transformed[pixel];
      }
      for (std::size_t l = 0; l < lanes; ++l) {
        at[l] = static_cast<float>(column[l] + x) - disparities[l];
        at_road[l] = at[l] - (road_surface[l] - transforms[l]);
      }
      row.read(at, lanes, measured[k]);
      row.read(at_road, lanes, road[k]);
    }
  }
  Lanes<float> along_measured, along_road;
  correlate(left, measured, lanes, along_measured);
  correlate(left, road, lanes, along_road);
  for (std::size_t l = 0; l < lanes; ++l) {
    if (u[first + l] != column[l]) continue;  // the block is not inside the image
    votes[first + l] = likelihood_vote(along_measured[l], along_road[l], block_pixels);
  }
}

void vote_for_blocks(const DamageInput& input, int v, std::span<const int> u, std::span<const float> surface,
                     std::span<float> votes) {
  std::fill(votes.begin(), votes.end(), 0.0F);
  if (v < block_radius || v + block_radius >= input.grey.height()) return;
  if (input.grey.width() <= 2 * block_radius) return;
  for (std::size_t first = 0; first < u.size(); first += max_lanes) vote_lanes(input, v, u, surface, first, votes);
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(vote_for_blocks);

void vote_for_blocks(const DamageInput& input, int v, std::span<const int> u, std::span<const float> surface,
                     std::span<float> votes) {
  HWY_DYNAMIC_DISPATCH(vote_for_blocks)(input, v, u, surface, votes);
}

}  // namespace roadstereo
#endif  // HWY_ONCE

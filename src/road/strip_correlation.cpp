#include "road/strip_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mid_grey.hpp"
#include "road/plane_search.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/strip_correlation.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Float = hn::Vec<Floats>;

/// The block whose first pixel is (u, v).
void cut_block(ImageView<const std::int16_t> image, int u, int v, CorrelationBlock& block) {
  const Floats df;
  const hn::Rebind<std::int16_t, Floats> d16;
  const hn::RebindToSigned<Floats> d32;
  const int lanes = static_cast<int>(hn::Lanes(df));
  auto sum = hn::Zero(d32), squares = hn::Zero(d32);  // of 135 levels within ±2040: fits
  const auto middle = hn::Set(d32, mid_grey);
  for (int y = 0; y < block.height; ++y) {
    const std::int16_t* row = image.row(v + y) + u;
    std::array<std::int16_t, CorrelationBlock::whole_vectors> copied;
    if (u + CorrelationBlock::whole_vectors > image.width()) {
      copied.fill(0);
      std::copy_n(row, block.width, copied.data());
      row = copied.data();
    }
    float* const values = block.values.data() + static_cast<std::ptrdiff_t>(y) * block.width;
    for (int x = 0; x < block.width; x += lanes) {
      const auto inside = hn::FirstN(d32, static_cast<std::size_t>(block.width - x));
      const auto grey = hn::IfThenElseZero(inside, hn::Sub(hn::PromoteTo(d32, hn::LoadU(d16, row + x)), middle));
      sum = hn::Add(sum, grey);
      squares = hn::Add(squares, hn::Mul(grey, grey));
      hn::StoreU(hn::ConvertTo(df, grey), df, values + x);
    }
  }
  const auto total = [d32](hn::Vec<decltype(d32)> sums) { return hn::GetLane(hn::SumOfLanes(d32, sums)); };
  const int pixels = block.width * block.height;
  const double mean = static_cast<double>(total(sum)) / pixels;
  block.deviation = static_cast<float>(block_deviation(static_cast<unsigned>(total(squares)), mean, pixels));
  const Float subtracted = hn::Set(df, static_cast<float>(mean));
  for (int i = 0; i < pixels; i += lanes) {
    float* const at = block.values.data() + i;
    hn::StoreU(hn::Sub(hn::LoadU(df, at), subtracted), df, at);
  }
}

/// Sums of a strip's columns and of their squares.
struct ColumnSums {
  std::array<float, Strip::pitch> values, squares;
};

HWY_INLINE void sum_columns(const StripView& strip, int first, int columns, int height, ColumnSums& sums) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  for (int x = 0; x < columns; x += lanes) {
    Float sum = hn::Zero(df), squares = hn::Zero(df);
    for (int y = 0; y < height; ++y) {
      const Float value = hn::LoadU(df, strip.row(y) + first + x);
      sum = hn::Add(sum, value);
      squares = hn::MulAdd(value, value, squares);
    }
    hn::StoreU(sum, df, sums.values.data() + x);
    hn::StoreU(squares, df, sums.squares.data() + x);
  }
}

void find_inverse_deviations(const StripView& strip, int width, int height, int count, float min_deviation,
                             float* inverse_deviations) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float per_pixel = hn::Set(df, 1.0f / static_cast<float>(width * height));
  const Float min_variance = hn::Set(df, min_deviation * min_deviation);
  ColumnSums sums;
  for (int first = 0; first < count; first += Strip::max_counts) {
    const int counted = std::min(Strip::max_counts, count - first);
    sum_columns(strip, first, counted + width - 1, height, sums);
    for (int i = 0; i < counted; i += lanes) {
      Float sum = hn::Zero(df), squares = hn::Zero(df);
      for (int x = 0; x < width; ++x) {
        sum = hn::Add(sum, hn::LoadU(df, sums.values.data() + i + x));
        squares = hn::Add(squares, hn::LoadU(df, sums.squares.data() + i + x));
      }
      const Float mean = hn::Mul(sum, per_pixel);
      const Float variance = hn::NegMulAdd(mean, mean, hn::Mul(squares, per_pixel));
      const Float inverse = hn::Div(hn::Set(df, 1.0f), hn::Sqrt(variance));
      hn::StoreU(hn::IfThenElseZero(hn::Ge(variance, min_variance), inverse), df, inverse_deviations + first + i);
    }
  }
}

/// Sums over the block of its values times the strip's, for the parts that begin at `first` and the columns behind it.
HWY_INLINE Float sum_products(const CorrelationBlock& block, const StripView& strip, int first) {
  const Floats df;
  Float even = hn::Zero(df), odd = hn::Zero(df);  // two chains hide each other's latency
  const float* value = block.values.data();
  for (int y = 0; y < block.height; ++y) {
    const float* row = strip.row(y) + first;
    int x = 0;
    for (; x + 1 < block.width; x += 2, value += 2) {
      even = hn::MulAdd(hn::Set(df, value[0]), hn::LoadU(df, row + x), even);
      odd = hn::MulAdd(hn::Set(df, value[1]), hn::LoadU(df, row + x + 1), odd);
    }
    if (x < block.width) even = hn::MulAdd(hn::Set(df, *value++), hn::LoadU(df, row + x), even);
  }
  return hn::Add(even, odd);
}

void correlate_strip(const CorrelationBlock& block, const StripView& strip, const float* inverse_deviations, int count,
                     StripValues& correlations) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float scale = hn::Set(df, 1.0f / (block.deviation * static_cast<float>(block.width * block.height)));
  for (int i = 0; i < count; i += lanes) {
    const Float inverse = hn::LoadU(df, inverse_deviations + i);
    const Float correlation = hn::Mul(hn::Mul(sum_products(block, strip, i), scale), inverse);
    const auto textured = hn::Gt(inverse, hn::Zero(df));
    hn::StoreU(hn::IfThenElse(textured, correlation, hn::Set(df, -1.0f)), df, correlations.data() + i);
  }
}

int index_of_highest(const StripValues& correlations, int count) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float beyond = hn::Set(df, -std::numeric_limits<float>::infinity());
  const auto values = [&](int i) {
    const auto counted = hn::FirstN(df, static_cast<std::size_t>(count - i));
    return hn::IfThenElse(counted, hn::LoadU(df, correlations.data() + i), beyond);
  };
  Float highest = beyond;
  for (int i = 0; i < count; i += lanes) highest = hn::Max(highest, values(i));
  highest = hn::MaxOfLanes(df, highest);
  for (int i = 0; i < count; i += lanes) {
    const std::intptr_t lane = hn::FindFirstTrue(df, hn::Eq(values(i), highest));
    if (lane >= 0) return i + static_cast<int>(lane);
  }
  return 0;
}

constexpr int max_drift = 16;  ///< pixels by which they may fall behind or run ahead along the strip

/// A column lies between two pixels of a few that come into question; each counts by its distance from the column, and
/// beyond a pixel's distance not at all.
void sample_strip(const std::int16_t* image_row, int image_width, double x, double step, int count, float* strip_row) {
  const Floats df;
  const hn::Rebind<std::int16_t, Floats> d16;
  const hn::RebindToSigned<Floats> d32;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const double drift = (step - 1) * (count - 1);
  const int base = static_cast<int>(std::floor(x + std::min(0.0, drift)));
  const int taps = static_cast<int>(x + std::max(0.0, drift) - base) + 2;
  // Whole vectors read beyond the last column; where the image has nothing there, they read a copy.
  std::array<std::int16_t, max_sampled + max_drift + 16> copied;
  const std::int16_t* pixels = copied.data();
  if (base >= 0 && base + count + taps + lanes <= image_width) {
    pixels = image_row + base;
  } else {
    const int first = std::max(0, base), last = std::min(image_width, base + count + taps);
    copied.fill(0);
    std::copy(image_row + first, image_row + last, copied.data() + (first - base));
  }
  const auto start = static_cast<float>(x - base);
  const Float slope = hn::Set(df, static_cast<float>(step - 1)), one = hn::Set(df, 1.0f);
  for (int i = 0; i < count; i += lanes) {
    const Float at = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(i)));
    const Float place = hn::MulAdd(at, slope, hn::Set(df, start));
    Float value = hn::Set(df, -static_cast<float>(mid_grey));
    for (int k = 0; k < taps; ++k) {
      const Float away = hn::Abs(hn::Sub(place, hn::Set(df, static_cast<float>(k))));
      const Float weight = hn::Max(hn::Sub(one, away), hn::Zero(df));
      const Float pixel = hn::ConvertTo(df, hn::PromoteTo(d32, hn::LoadU(d16, pixels + i + k)));
      value = hn::MulAdd(weight, pixel, value);
    }
    hn::StoreU(value, df, strip_row + i);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(cut_block);
HWY_EXPORT(find_inverse_deviations);
HWY_EXPORT(correlate_strip);
HWY_EXPORT(index_of_highest);
HWY_EXPORT(sample_strip);

CorrelationBlock::CorrelationBlock(ImageView<const std::int16_t> image, int u, int v, int half_width, int half_height)
    : width(2 * half_width + 1), height(2 * half_height + 1) {
  HWY_DYNAMIC_DISPATCH(cut_block)(image, u - half_width, v - half_height, *this);
}

void find_inverse_deviations(const StripView& strip, int width, int height, int count, float min_deviation,
                             float* inverse_deviations) {
  HWY_DYNAMIC_DISPATCH(find_inverse_deviations)(strip, width, height, count, min_deviation, inverse_deviations);
}

void correlate_strip(const CorrelationBlock& block, const StripView& strip, const float* inverse_deviations, int count,
                     StripValues& correlations) {
  HWY_DYNAMIC_DISPATCH(correlate_strip)(block, strip, inverse_deviations, count, correlations);
}

int index_of_highest(const StripValues& correlations, int count) {
  return HWY_DYNAMIC_DISPATCH(index_of_highest)(correlations, count);
}

void sample_strip(const std::int16_t* image_row, int image_width, double x, double step, int count, float* strip_row) {
  HWY_DYNAMIC_DISPATCH(sample_strip)(image_row, image_width, x, step, count, strip_row);
}

}  // namespace roadstereo
#endif  // HWY_ONCE

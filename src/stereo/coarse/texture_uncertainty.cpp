#include "stereo/coarse/texture_uncertainty.hpp"

#include <algorithm>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/coarse/texture_uncertainty.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// Adds `sign` times the gradients of the columns 1 … `end` − 1 of a row to the sums of their squares and products.
void add_gradients(const std::int16_t* above, const std::int16_t* row, const std::int16_t* below, int end, int sign,
                   std::int32_t* HWY_RESTRICT squares, std::int32_t* HWY_RESTRICT products) {
  for (int u = 1; u < end; ++u) {
    const CoarseGradient gradient = coarse_gradient(row[u - 1], row[u + 1], above[u], below[u]);
    squares[u] += sign * gradient.across * gradient.across;
    products[u] += sign * gradient.across * gradient.down;
  }
}

void uncertainties(const std::int32_t* squares, const std::int32_t* products, int columns, UncertaintyParams terms,
                   float* HWY_RESTRICT uncertainty) {
  for (int u = 0; u < columns; ++u) uncertainty[u] = texture_uncertainty(squares[u], products[u], terms);
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(add_gradients);
HWY_EXPORT(uncertainties);

namespace {

/// Sums of the numbers up to `radius` away, as far as there are any.
void sum_windows(const std::vector<std::int32_t>& numbers, int radius, std::vector<std::int32_t>& sums) {
  const auto count = static_cast<int>(numbers.size());
  const std::int32_t* const at = numbers.data();
  std::int32_t* const to = sums.data();
  std::int32_t sum = std::accumulate(at, at + std::min(radius, count), 0);
  int u = 0;
  for (; u < std::min(radius, count); ++u) to[u] = sum += u + radius < count ? at[u + radius] : 0;
  for (; u + radius < count; ++u) {
    to[u] = sum += at[u + radius];
    sum -= at[u - radius];
  }
  for (; u < count; ++u) {
    to[u] = sum;
    sum -= at[u - radius];
  }
}

}  // namespace

void TextureUncertainty::prepare(int columns) {
  squares_.reserve(static_cast<std::size_t>(columns));
  products_.reserve(static_cast<std::size_t>(columns));
  window_squares_.reserve(static_cast<std::size_t>(columns));
  window_products_.reserve(static_cast<std::size_t>(columns));
  texture_uncertainty_.reserve(static_cast<std::size_t>(columns));
}

void TextureUncertainty::start(ImageView<const std::int16_t> image, int first_row,
                               const TextureUncertaintyOptions& options) {
  image_ = image;
  options_ = options;
  row_ = first_row;
  const auto columns = static_cast<std::size_t>(image.width());
  squares_.assign(columns, 0);
  products_.assign(columns, 0);
  window_squares_.resize(columns);
  window_products_.resize(columns);
  texture_uncertainty_.resize(columns);
  for (int v = first_row - options.block_radius; v < first_row + options.block_radius; ++v) add_row(v, 1);
}

/// Adds the gradients of one row to the column sums, or takes them away; rows without both neighbours have none.
void TextureUncertainty::add_row(int v, int sign) {
  if (v < 1 || v + 1 >= image_.height()) return;
  HWY_DYNAMIC_DISPATCH(add_gradients)
  (image_.row(v - 1), image_.row(v), image_.row(v + 1), image_.width() - 1, sign, squares_.data(), products_.data());
}

const std::vector<float>& TextureUncertainty::next() {
  const int radius = options_.block_radius;
  add_row(row_ + radius, 1);
  const UncertaintyParams terms = uncertainty_params(options_);
  sum_windows(squares_, radius, window_squares_);
  sum_windows(products_, radius, window_products_);
  HWY_DYNAMIC_DISPATCH(uncertainties)
  (window_squares_.data(), window_products_.data(), image_.width(), terms, texture_uncertainty_.data());
  add_row(row_ - radius, -1);
  ++row_;
  return texture_uncertainty_;
}

}  // namespace roadstereo
#endif  // HWY_ONCE

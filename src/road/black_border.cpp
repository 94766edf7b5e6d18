#include "road/black_border.hpp"

#include <algorithm>
#include <cstddef>

#include "road/repeated_border.hpp"
#include "roadstereo/grey_scale.hpp"

namespace roadstereo {
namespace {

/// What is black at most: compression leaves a little. In a dark picture a tenth of its mean is less.
std::int16_t black_level(ImageView<const std::int16_t> grey) {
  constexpr int step = 8, share = 10;
  constexpr std::int64_t most = std::int64_t{3} * grey_scale;  // of 255 levels
  std::int64_t sum = 0, count = 0;
  for (int v = 0; v < grey.height(); v += step) {
    for (int u = 0; u < grey.width(); u += step) sum += grey(u, v);
    count += (grey.width() + step - 1) / step;
  }
  return static_cast<std::int16_t>(std::min(most, sum / (share * count)));
}

/// Whether enough of the pixels along the sides are black for a border: of most pictures nothing else need be looked
/// at.
bool has_black_sides(ImageView<const std::int16_t> grey, std::int16_t black) {
  constexpr int least = 50;  // one in so many pixels
  const int width = grey.width(), height = grey.height();
  int count = 0;
  for (const int v : {0, height - 1}) {
    const std::int16_t* const row = grey.row(v);
    count += static_cast<int>(std::count_if(row, row + width, [=](std::int16_t level) { return level <= black; }));
  }
  for (int v = 0; v < height; ++v) count += (grey(0, v) <= black ? 1 : 0) + (grey(width - 1, v) <= black ? 1 : 0);
  return least * count >= 2 * (width + height);
}

/// Marks what is black from the first and the last column on.
std::size_t mark_sides(const std::int16_t* grey, int width, std::int16_t black, std::uint8_t* outside) {
  const auto* const end = grey + width;
  const auto is_picture = [=](std::int16_t level) { return level > black; };
  const auto left = std::find_if(grey, end, is_picture) - grey;
  if (left == width) {
    std::fill_n(outside, width, std::uint8_t{255});
    return static_cast<std::size_t>(width);
  }
  std::ptrdiff_t right = 0;
  while (grey[width - 1 - right] <= black) ++right;
  std::fill_n(outside, left, std::uint8_t{255});
  std::fill_n(outside + width - right, right, std::uint8_t{255});
  return static_cast<std::size_t>(left + right);
}

/// Marks in row v what is black and marked in the row before it, `step` away.
std::size_t continue_columns(ImageView<const std::int16_t> grey, std::int16_t black, int v, int step,
                             ImageView<std::uint8_t> outside) {
  const std::int16_t* const level = grey.row(v);
  const std::uint8_t* const before = outside.row(v - step);
  std::uint8_t* const here = outside.row(v);
  std::size_t marked = 0;
  for (int u = 0; u < grey.width(); ++u) {
    const bool continues = before[u] != 0 && level[u] <= black && here[u] == 0;
    here[u] = continues ? std::uint8_t{255} : here[u];
    marked += continues ? 1 : 0;
  }
  return marked;
}

/// Marks in `outside`, 0 until now, what is black from a side on. Returns the number of pixels.
std::size_t mark_border(ImageView<const std::int16_t> grey, std::int16_t black, ImageView<std::uint8_t> outside) {
  const int width = grey.width(), height = grey.height();
  std::size_t marked = 0;
  for (int v = 0; v < height; ++v) marked += mark_sides(grey.row(v), width, black, outside.row(v));
  for (const int v : {0, height - 1}) {
    std::transform(grey.row(v), grey.row(v) + width, outside.row(v),
                   [=](std::int16_t level) { return level <= black ? std::uint8_t{255} : std::uint8_t{0}; });
  }
  for (int v = 1; v < height; ++v) marked += continue_columns(grey, black, v, 1, outside);
  for (int v = height - 2; v >= 0; --v) marked += continue_columns(grey, black, v, -1, outside);
  return marked;
}

void mark_repeated(const RepeatedBorder& border, ImageView<std::uint8_t> outside) {
  for (int v = 0; v < outside.height(); ++v) {
    std::uint8_t* const row = outside.row(v);
    const bool is_border = v < border.top || v >= outside.height() - border.bottom;
    std::fill_n(row, is_border ? outside.width() : border.left, std::uint8_t{255});
    std::fill_n(row + outside.width() - border.right, border.right, std::uint8_t{255});
  }
}

}  // namespace

PictureMask::PictureMask(ImageView<const std::int16_t> grey, ImageView<const std::uint8_t> mask)
    : outside_(scratch_vector<std::uint8_t>()), view_(mask) {
  if (grey.empty()) return;
  constexpr std::size_t noteworthy = 500;  // one in so many pixels
  const std::int16_t black = black_level(grey);
  const bool has_black = has_black_sides(grey, black);
  const RepeatedBorder repeated = find_repeated_border(grey);
  if (!has_black && repeated.empty()) return;
  const int width = grey.width(), height = grey.height();
  outside_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  const ImageView<std::uint8_t> outside(outside_.data(), width, height, width);
  if (has_black && mark_border(grey, black, outside) * noteworthy < outside_.size()) {
    if (repeated.empty()) return;
    std::fill(outside_.begin(), outside_.end(), std::uint8_t{0});
  }
  mark_repeated(repeated, outside);
  for (int v = 0; v < height && !mask.empty(); ++v) {
    std::transform(mask.row(v), mask.row(v) + width, outside.row(v), outside.row(v),
                   [](std::uint8_t masked, std::uint8_t here) { return masked != 0 ? std::uint8_t{255} : here; });
  }
  view_ = outside;
}

}  // namespace roadstereo

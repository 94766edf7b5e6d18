#include "damage/grow.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace roadstereo {
namespace {

void unite_with(const std::uint8_t* other, int count, std::uint8_t* cells) {
  for (int i = 0; i < count; ++i) cells[i] |= other[i];
}

/// Unions of `count` neighbours along a line are made of unions of 1, 2, 4 … of them: calls `step(shift)` for each
/// doubling, and for the rest that is left.
template <class Step>
void double_up(int count, const Step& step) {
  const auto widest = static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
  for (int held = 1; held < widest; held *= 2) step(held);
  if (count > widest) step(count - widest);
}

/// Grows along the rows.
Image<std::uint8_t> grow_along(const Image<std::uint8_t>& mask, int radius) {
  const int width = mask.width();
  const int padded = width + 2 * radius;
  Image<std::uint8_t> grown(width, mask.height());
  std::vector<std::uint8_t> line(static_cast<std::size_t>(padded));
  std::vector<std::uint8_t> next(line.size());
  for (int j = 0; j < mask.height(); ++j) {
    std::fill(line.begin(), line.end(), std::uint8_t{0});
    std::copy_n(mask.row(j), width, line.begin() + radius);
    double_up(2 * radius + 1, [&](int shift) {
      next = line;
      unite_with(next.data() + shift, padded - shift, line.data());
    });
    std::copy_n(line.begin(), width, grown.row(j));
  }
  return grown;
}

/// Grows across the rows.
Image<std::uint8_t> grow_across(const Image<std::uint8_t>& mask, int radius) {
  Image<std::uint8_t> lines(mask.width(), mask.height() + 2 * radius, 0);
  std::copy_n(mask.row(0), mask.pixels(), lines.row(radius));
  double_up(2 * radius + 1, [&](int shift) {
    for (int j = 0; j + shift < lines.height(); ++j) unite_with(lines.row(j + shift), lines.width(), lines.row(j));
  });
  Image<std::uint8_t> grown(mask.width(), mask.height());
  std::copy_n(lines.row(0), grown.pixels(), grown.row(0));
  return grown;
}

Image<std::uint8_t> inverted(Image<std::uint8_t> mask) {
  std::uint8_t* const cells = mask.row(0);
  for (std::size_t k = 0; k < mask.pixels(); ++k) cells[k] = static_cast<std::uint8_t>(~cells[k]);
  return mask;
}

}  // namespace

Image<std::uint8_t> grow(const Image<std::uint8_t>& mask, int radius) {
  return grow_across(grow_along(mask, radius), radius);
}

Image<std::uint8_t> shrink_mask(const Image<std::uint8_t>& mask, int radius) {
  return inverted(grow(inverted(mask), radius));
}

BoxMask grow(const BoxMask& mask, int radius, const Box& box) {
  return {box, grow(mask.within(box).cells(), radius)};
}

BoxMask shrink_mask(const BoxMask& mask, int radius, const Box& box) {
  return {box, shrink_mask(mask.within(box).cells(), radius)};
}

}  // namespace roadstereo

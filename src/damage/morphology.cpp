#include "damage/morphology.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace roadstereo {
namespace {

void unite_with(const std::uint8_t* other, int count, std::uint8_t* cells) {
  for (int i = 0; i < count; ++i) cells[i] |= other[i];
}

/// Unite `count` neighbours along a line by doubling, in log2(count) steps: calls `step(shift)` for shifts of 1, 2, 4 …
/// cells and, if `count` is not a power of two, for the remainder.
template <class Step>
void unite_by_doubling(int count, const Step& step) {
  const auto power = static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
  for (int united = 1; united < power; united *= 2) step(united);
  if (count > power) step(count - power);
}

Image<std::uint8_t> dilate_rows(const Image<std::uint8_t>& mask, int radius) {
  const int width = mask.width();
  const int padded = width + 2 * radius;
  Image<std::uint8_t> dilated(width, mask.height());
  std::vector<std::uint8_t> line(static_cast<std::size_t>(padded));
  std::vector<std::uint8_t> next(line.size());
  for (int j = 0; j < mask.height(); ++j) {
    std::fill(line.begin(), line.end(), std::uint8_t{0});
    std::copy_n(mask.row(j), width, line.begin() + radius);
    unite_by_doubling(2 * radius + 1, [&](int shift) {
      next = line;
      unite_with(next.data() + shift, padded - shift, line.data());
    });
    std::copy_n(line.begin(), width, dilated.row(j));
  }
  return dilated;
}

Image<std::uint8_t> dilate_columns(const Image<std::uint8_t>& mask, int radius) {
  Image<std::uint8_t> lines(mask.width(), mask.height() + 2 * radius, 0);
  std::copy_n(mask.row(0), mask.pixels(), lines.row(radius));
  unite_by_doubling(2 * radius + 1, [&](int shift) {
    for (int j = 0; j + shift < lines.height(); ++j) unite_with(lines.row(j + shift), lines.width(), lines.row(j));
  });
  Image<std::uint8_t> dilated(mask.width(), mask.height());
  std::copy_n(lines.row(0), dilated.pixels(), dilated.row(0));
  return dilated;
}

Image<std::uint8_t> inverted(Image<std::uint8_t> mask) {
  std::uint8_t* const cells = mask.row(0);
  for (std::size_t k = 0; k < mask.pixels(); ++k) cells[k] = static_cast<std::uint8_t>(~cells[k]);
  return mask;
}

}  // namespace

Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int radius) {
  return dilate_columns(dilate_rows(mask, radius), radius);
}

Image<std::uint8_t> erode(const Image<std::uint8_t>& mask, int radius) {
  return inverted(dilate(inverted(mask), radius));
}

BoxMask dilate(const BoxMask& mask, int radius, const CellBox& box) {
  return {box, dilate(mask.cropped(box).cells(), radius)};
}

BoxMask erode(const BoxMask& mask, int radius, const CellBox& box) {
  return {box, erode(mask.cropped(box).cells(), radius)};
}

}  // namespace roadstereo

#include "damage/morphology.hpp"

#include <algorithm>
#include <bit>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

void unite_with(const std::uint8_t* other, int count, std::uint8_t* cells) {
  for (int i = 0; i < count; ++i) cells[i] |= other[i];
}

void copy_inverted(const std::uint8_t* cells, std::uint8_t inverse, int count, std::uint8_t* copies) {
  for (int i = 0; i < count; ++i) copies[i] = cells[i] ^ inverse;
}

/// Unite every cell of a line with the one `shift` cells after it.
void unite_shifted(const std::uint8_t* cells, int shift, int count, std::uint8_t* united) {
  for (int i = 0; i < count; ++i) united[i] = cells[i] | cells[i + shift];
}

/// Unite `count` neighbours along a line by doubling, in log2(count) steps: calls `step(shift)` for shifts of 1, 2, 4 …
/// cells and, if `count` is not a power of two, for the remainder.
template <class Step>
void unite_by_doubling(int count, const Step& step) {
  const auto power = static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
  for (int united = 1; united < power; united *= 2) step(united);
  if (count > power) step(count - power);
}

/// Dilate the rows `first` … `end` − 1.
void dilate_rows(Image<std::uint8_t>& lines, int first, int end, int radius) {
  const int width = lines.width();
  const int padded = width + 2 * radius;
  std::vector<std::uint8_t> line(static_cast<std::size_t>(padded));
  std::vector<std::uint8_t> next(static_cast<std::size_t>(padded));
  for (int j = first; j < end; ++j) {
    std::fill(line.begin(), line.end(), std::uint8_t{0});
    std::copy_n(lines.row(j), width, line.begin() + radius);
    int count = padded;
    unite_by_doubling(2 * radius + 1, [&](int shift) {
      count -= shift;
      unite_shifted(line.data(), shift, count, next.data());
      line.swap(next);
    });
    std::copy_n(line.begin(), width, lines.row(j));
  }
}

/// Dilate a mask, or its inverse, by a rectangle, and invert the result again.
Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int columns, int rows, std::uint8_t inverse, int threads) {
  constexpr int rows_per_band = 64;
  const int width = mask.width(), height = mask.height();
  Image<std::uint8_t> dilated(width, height);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    Image<std::uint8_t> lines(width, last - first + 2 * rows, 0);
    const int top = std::max(0, first - rows), bottom = std::min(height, last + rows);
    for (int j = top; j < bottom; ++j) copy_inverted(mask.row(j), inverse, width, lines.row(j - first + rows));
    dilate_rows(lines, top - first + rows, bottom - first + rows, columns);
    unite_by_doubling(2 * rows + 1, [&](int shift) {
      for (int j = 0; j + shift < lines.height(); ++j) unite_with(lines.row(j + shift), width, lines.row(j));
    });
    for (int j = first; j < last; ++j) copy_inverted(lines.row(j - first), inverse, width, dilated.row(j));
  });
  return dilated;
}

}  // namespace

Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int radius, int threads) {
  return dilate(mask, radius, radius, 0, threads);
}

Image<std::uint8_t> erode(const Image<std::uint8_t>& mask, int radius, int threads) {
  return dilate(mask, radius, radius, 255, threads);
}

BoxMask dilate(const BoxMask& mask, int columns, int rows, const CellBox& box) {
  return {box, dilate(mask.cropped(box).cells(), columns, rows, 0, 1)};
}

BoxMask dilate(const BoxMask& mask, int radius, const CellBox& box) {
  return dilate(mask, radius, radius, box);
}

BoxMask erode(const BoxMask& mask, int radius, const CellBox& box) {
  return {box, erode(mask.cropped(box).cells(), radius, 1)};
}

}  // namespace roadstereo

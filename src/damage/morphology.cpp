#include "damage/morphology.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "core/parallel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "damage/morphology.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Unite each of `count` cells with the one `shift` cells after it.
void unite_shifted(std::size_t count, std::size_t shift, std::uint8_t* cells) {
  const hn::ScalableTag<std::uint8_t> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::StoreU(hn::Or(hn::LoadU(d, cells + i), hn::LoadU(d, cells + i + shift)), d, cells + i);
  }
  for (; i < count; ++i) cells[i] |= cells[i + shift];
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {
namespace {

HWY_EXPORT(unite_shifted);

/// Unite each of the first cells with the `count` − 1 that follow it at that stride, as far as there are `size` cells.
/// By doubling, in log2(count) steps: with shifts of 1, 2, 4 … strides and, if `count` is not a power of two, the rest.
void unite_following(std::size_t size, int count, std::size_t stride, std::uint8_t* cells) {
  const auto unite = [&](int strides) {
    const std::size_t shift = static_cast<std::size_t>(strides) * stride;
    size -= shift;
    HWY_DYNAMIC_DISPATCH(unite_shifted)(size, shift, cells);
  };
  const auto power = static_cast<int>(std::bit_floor(static_cast<unsigned>(count)));
  for (int united = 1; united < power; united *= 2) unite(united);
  if (count > power) unite(count - power);
}

/// Dilate the cells of a box by a rectangle, as far as another box, which they reach. `read(j, cells)` writes those of
/// row j; `write(j, cells)` takes what row j of the other box becomes.
template <class Read, class Write>
void dilate(const CellBox& from, const CellBox& to, int columns, int rows, const Read& read, const Write& write) {
  const int width = to.columns() + 2 * columns;  // the margins keep the rows apart
  const int column = from.first_column - to.first_column + columns, row = from.first_row - to.first_row + rows;
  const auto stride = static_cast<std::size_t>(width);
  Image<std::uint8_t> lines(width, to.rows() + 2 * rows, 0);
  for (int j = 0; j < from.rows(); ++j) read(from.first_row + j, lines.row(row + j) + column);
  unite_following(stride * static_cast<std::size_t>(from.rows()), 2 * columns + 1, 1, lines.row(row));
  unite_following(lines.pixels(), 2 * rows + 1, stride, lines.row(0));
  for (int j = 0; j < to.rows(); ++j) write(to.first_row + j, lines.row(j));
}

void copy_inverted(const std::uint8_t* cells, std::uint8_t inverse, int count, std::uint8_t* copies) {
  for (int i = 0; i < count; ++i) copies[i] = cells[i] ^ inverse;
}

/// Dilate a mask, or its inverse, by a square, and invert the result again.
Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int radius, std::uint8_t inverse, int threads) {
  constexpr int rows_per_band = 64;
  const int width = mask.width(), height = mask.height();
  Image<std::uint8_t> dilated;
  dilated.resize(width, height);
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    const CellBox to{0, first, width - 1, last - 1};
    const CellBox from{0, std::max(0, first - radius), width - 1, std::min(height, last + radius) - 1};
    dilate(
        from, to, radius, radius,
        [&](int j, std::uint8_t* cells) { copy_inverted(mask.row(j), inverse, width, cells); },
        [&](int j, const std::uint8_t* cells) { copy_inverted(cells, inverse, width, dilated.row(j)); });
  });
  return dilated;
}

}  // namespace

Image<std::uint8_t> dilate(const Image<std::uint8_t>& mask, int radius, int threads) {
  return dilate(mask, radius, std::uint8_t{0}, threads);
}

Image<std::uint8_t> erode(const Image<std::uint8_t>& mask, int radius, int threads) {
  return dilate(mask, radius, std::uint8_t{255}, threads);
}

BoxMask dilate(const BoxMask& mask, int columns, int rows, const CellBox& box) {
  BoxMask dilated(box);
  const CellBox from = mask.box().clipped(box), to = from.grown(columns, rows).clipped(box);
  if (from.empty()) return dilated;
  const int left = from.first_column - mask.box().first_column, start = to.first_column - box.first_column;
  dilate(
      from, to, columns, rows,
      [&](int j, std::uint8_t* cells) {
        std::copy_n(mask.cells().row(j - mask.box().first_row) + left, from.columns(), cells);
      },
      [&](int j, const std::uint8_t* cells) {
        std::copy_n(cells, to.columns(), dilated.cells().row(j - box.first_row) + start);
      });
  return dilated;
}

BoxMask dilate(const BoxMask& mask, int radius, const CellBox& box) {
  return dilate(mask, radius, radius, box);
}

BoxMask erode(const BoxMask& mask, int radius, const CellBox& box) {
  return {box, erode(mask.cropped(box).cells(), radius, 1)};
}

}  // namespace roadstereo
#endif  // HWY_ONCE

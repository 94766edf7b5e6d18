#include "damage/connected_regions.hpp"

#include <algorithm>

namespace roadstereo {

void Box::add(int column, int row) {
  if (empty()) {
    *this = {column, row, column, row};
    return;
  }
  first_column = std::min(first_column, column);
  first_row = std::min(first_row, row);
  last_column = std::max(last_column, column);
  last_row = std::max(last_row, row);
}

Box Box::grown(int by, int width, int height) const {
  return {std::max(0, first_column - by), std::max(0, first_row - by), std::min(width - 1, last_column + by),
          std::min(height - 1, last_row + by)};
}

std::vector<ConnectedRegion> connected_regions(const Image<std::uint8_t>& mask) {
  const int width = mask.width();
  const int height = mask.height();
  Image<std::uint8_t> open = mask;
  std::vector<ConnectedRegion> regions;
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      if (open(i, j) == 0) continue;
      ConnectedRegion& region = regions.emplace_back();
      const auto take = [&](int column, int row) {
        if (open(column, row) == 0) return;
        open(column, row) = 0;
        region.cells.push_back(row * width + column);
      };
      take(i, j);
      for (std::size_t next = 0; next < region.cells.size(); ++next) {
        const int column = region.cells[next] % width;
        const int row = region.cells[next] / width;
        region.box.add(column, row);
        if (column > 0) take(column - 1, row);
        if (column + 1 < width) take(column + 1, row);
        if (row > 0) take(column, row - 1);
        if (row + 1 < height) take(column, row + 1);
      }
      region.touches_border = region.box.first_column == 0 || region.box.first_row == 0 ||
                              region.box.last_column == width - 1 || region.box.last_row == height - 1;
    }
  }
  return regions;
}

void fill_enclosed(Image<std::uint8_t>& mask, const Box& box, std::size_t most_cells) {
  Image<std::uint8_t> outside(box.last_column - box.first_column + 1, box.last_row - box.first_row + 1);
  for (int j = 0; j < outside.height(); ++j) {
    for (int i = 0; i < outside.width(); ++i) {
      outside(i, j) = mask(box.first_column + i, box.first_row + j) == 0 ? 255 : 0;
    }
  }
  for (const ConnectedRegion& region : connected_regions(outside)) {
    if (region.touches_border || region.cells.size() > most_cells) continue;
    for (const std::int32_t cell : region.cells) {
      mask(box.first_column + cell % outside.width(), box.first_row + cell / outside.width()) = 255;
    }
  }
}

namespace {

/// Whether any cell within `radius` along one line is `wanted`: distances from the last such cell, forth and back.
template <class At>
void spread_along(int length, int radius, std::uint8_t wanted, const At& at, std::vector<std::uint8_t>& result) {
  result.assign(static_cast<std::size_t>(length), 0);
  int last = -radius - 1;
  for (int i = 0; i < length; ++i) {
    if ((at(i) != 0) == (wanted != 0)) last = i;
    if (i - last <= radius) result[static_cast<std::size_t>(i)] = 1;
  }
  last = length + radius;
  for (int i = length - 1; i >= 0; --i) {
    if ((at(i) != 0) == (wanted != 0)) last = i;
    if (last - i <= radius) result[static_cast<std::size_t>(i)] = 1;
  }
}

/// Gives every cell of the box within `radius` of one that is `wanted` (set or not) that state.
Image<std::uint8_t> spread(const Image<std::uint8_t>& mask, int radius, const Box& box, std::uint8_t wanted) {
  const std::uint8_t other = wanted != 0 ? 0 : 255;
  const int columns = box.last_column - box.first_column + 1;
  const int rows = box.last_row - box.first_row + 1;
  Image<std::uint8_t> along(columns, rows);
  Image<std::uint8_t> result(mask.width(), mask.height(), 0);
  std::vector<std::uint8_t> line;
  for (int j = 0; j < rows; ++j) {
    const std::uint8_t* row = mask.row(box.first_row + j) + box.first_column;
    spread_along(
        columns, radius, wanted, [row](int i) { return row[i]; }, line);
    for (int i = 0; i < columns; ++i) along(i, j) = line[static_cast<std::size_t>(i)] != 0 ? wanted : other;
  }
  for (int i = 0; i < columns; ++i) {
    spread_along(
        rows, radius, wanted, [&](int j) { return along(i, j); }, line);
    for (int j = 0; j < rows; ++j) {
      result(box.first_column + i, box.first_row + j) = line[static_cast<std::size_t>(j)] != 0 ? wanted : other;
    }
  }
  return result;
}

}  // namespace

Image<std::uint8_t> grow(const Image<std::uint8_t>& mask, int radius, const Box& box) {
  return spread(mask, radius, box, 255);
}

Image<std::uint8_t> shrink_mask(const Image<std::uint8_t>& mask, int radius, const Box& box) {
  return spread(mask, radius, box, 0);
}

}  // namespace roadstereo

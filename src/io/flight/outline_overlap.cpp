#include "io/flight/outline_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::io {
namespace {

double area_of(const Outline& outline) {
  double twice = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto &a = outline[k], &b = outline[(k + 1) % outline.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return 0.5 * std::abs(twice);
}

/// Smallest and largest y.
std::array<double, 2> range_of(const Outline& outline) {
  const auto [low, high] =
      std::minmax_element(outline.begin(), outline.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  return {(*low)[1], (*high)[1]};
}

/// Where a line of constant y enters and leaves a polygon, in order.
std::vector<double> crossings(const Outline& outline, double y) {
  std::vector<double> at;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto &a = outline[k], &b = outline[(k + 1) % outline.size()];
    if ((a[1] <= y) != (b[1] <= y)) at.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
  }
  std::sort(at.begin(), at.end());
  return at;
}

/// Length that the intervals between successive pairs of both lists have in common.
double common_length(const std::vector<double>& one, const std::vector<double>& other) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < one.size(); i += 2) {
    for (std::size_t k = 0; k + 1 < other.size(); k += 2) {
      length += std::max(0.0, std::min(one[i + 1], other[k + 1]) - std::max(one[i], other[k]));
    }
  }
  return length;
}

}  // namespace

double outline_overlap(const Outline& one, const Outline& other) {
  constexpr int lines = 32;
  if (one.empty() || other.empty()) return 0;
  const double smaller = std::min(area_of(one), area_of(other));
  const auto range = range_of(one), other_range = range_of(other);
  const double low = std::max(range[0], other_range[0]), high = std::min(range[1], other_range[1]);
  if (!(smaller > 0) || !(low < high)) return 0;
  const double spacing = (high - low) / lines;
  double common = 0;
  for (int k = 0; k < lines; ++k) {
    const double y = low + (k + 0.5) * spacing;
    common += spacing * common_length(crossings(one, y), crossings(other, y));
  }
  return std::min(1.0, common / smaller);
}

std::set<std::array<int, 2>> cells_of(const Outline& outline) {
  std::set<std::array<int, 2>> cells;
  if (outline.empty()) return cells;
  const auto first_centre = [](double at) { return static_cast<int>(std::ceil(at / outline_cell_m - 0.5)); };
  const auto [low, high] = range_of(outline);
  for (int row = first_centre(low); row < first_centre(high); ++row) {
    const std::vector<double> at = crossings(outline, (row + 0.5) * outline_cell_m);
    for (std::size_t k = 0; k + 1 < at.size(); k += 2) {
      for (int column = first_centre(at[k]); column < first_centre(at[k + 1]); ++column) cells.insert({column, row});
    }
  }
  return cells;
}

}  // namespace roadstereo::io

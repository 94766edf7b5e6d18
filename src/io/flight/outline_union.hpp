#pragma once

#include <array>
#include <set>

#include "io/flight/outline_overlap.hpp"

namespace roadstereo::io {

/// What outlines of a plane cover together.
class OutlineUnion {
 public:
  void add(const Outline& outline);

  /// Area of the cells that are covered, m².
  double area_m2() const;

  /// Unit vector of the principal axis along which the covered cells spread most; (1, 0) without any.
  std::array<double, 2> axis() const;

  /// Distance between the outermost vertices along a unit vector, metres.
  double extent_m(const std::array<double, 2>& along) const;

 private:
  std::set<std::array<int, 2>> cells_;  ///< of `cells_of`
  std::array<double, 2> sum_{};         ///< of columns and rows
  std::array<double, 3> squares_{};     ///< sums of column², column·row and row²
  Outline hull_;                        ///< convex
};

}  // namespace roadstereo::io

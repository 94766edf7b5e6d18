#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Length of the straightedge with which the depth of damage is measured by hand, metres (EN 13036-7).
inline constexpr double straightedge_m = 3;

/// Undulation: heights of the road about its quadratic surface, at the nodes of a grid on the road, bilinear in
/// between. A node reaches as far as a straightedge, so that damage of half that size stays out of a robust fit.
class RoadUndulation {
 public:
  /// None.
  RoadUndulation() = default;
  /// A grid over samples at (x, y), metres; all heights 0. A road of one cell of the grid has none.
  RoadUndulation(std::span<const double> x, std::span<const double> y);

  bool empty() const { return heights_.empty(); }
  /// Weighted least squares of scale·height to the values of the samples, with the variance of the steps between nodes
  /// as a prior. `weight`: inverse variances.
  void fit(std::span<const double> scale, std::span<const double> value, std::span<const double> weight);
  /// Height at sample k, metres.
  double height(std::size_t k) const { return height(places_[k]); }
  /// Add scale·height to `count` values of places (x, y); NaN stays NaN.
  void add_to(const float* x, const float* y, const float* scale, int count, float* values) const;

 private:
  /// Node to the lower left of a place, and where the place lies between the nodes, 0 … 1.
  struct Place {
    int column, row;
    float right, up;
  };
  /// Inline for the loop over many, which is vectorised.
  Place place(float x, float y) const {
    // The order of the operands turns NaN into 0.
    const auto between = [this](float from_first, int nodes) {
      return std::min(std::max(0.0F, from_first * per_metre_), static_cast<float>(nodes - 1));
    };
    const float column = between(x - first_x_, heights_.width()), row = between(y - first_y_, heights_.height());
    const int i = std::min(static_cast<int>(column), heights_.width() - 2);
    const int j = std::min(static_cast<int>(row), heights_.height() - 2);
    return {i, j, column - static_cast<float>(i), row - static_cast<float>(j)};
  }
  float height(const Place& at) const {
    const float *const low = heights_.row(at.row) + at.column, *const high = low + heights_.width();
    const float below = low[0] + at.right * (low[1] - low[0]), above = high[0] + at.right * (high[1] - high[0]);
    return below + at.up * (above - below);
  }

  double spacing_m_ = 0;  ///< from node to node
  float first_x_ = 0, first_y_ = 0, per_metre_ = 0;
  Image<float> heights_;
  std::vector<Place> places_;  ///< of the samples
};

}  // namespace roadstereo

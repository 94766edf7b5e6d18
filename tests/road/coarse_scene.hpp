#pragma once

#include <algorithm>

#include "roadstereo/image.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"

namespace roadstereo::test {

/// A street that was matched as if there were nothing but its road, which has the disparity 0.25 (v − 95.5) below the
/// horizon, and something 3 pixels nearer than infinity above it; the coarse map shows the same. Residual disparities
/// of the road are 8 pixels, where the disparity is as large.
struct StreetMaps {
  Image<float> disparity, sigma;
  DisparityPrior coarse;
  PerspectiveShift shift;

  StreetMaps(int width, int height, int factor) : disparity(width, height), sigma(width, height, 0.1F) {
    constexpr float above_horizon = 3;
    shift.road = {-0.25 * 95.5, 0.25, 0};
    shift.delta_p = 8;
    shift.disparities = 16;
    coarse.factor = factor;
    coarse.disparity.resize(width / factor, height / factor);
    const auto road = [&](double v) { return static_cast<float>(std::max(0.0, shift.road.disparity(0, v))); };
    for (int v = 0; v < height; ++v) {
      std::fill_n(disparity.row(v), width, v < horizon ? above_horizon : road(v));
    }
    for (int y = 0; y < coarse.disparity.height(); ++y) {
      const double v = factor * (y + 0.5) - 0.5;
      std::fill_n(coarse.disparity.row(y), coarse.disparity.width(),
                  v < horizon ? above_horizon : std::min(road(v), static_cast<float>(shift.delta_p)));
    }
  }

  struct Cells {
    int left, top, right, bottom;  ///< of 4×4 pixels; right and bottom excluded
  };

  /// Adds to the coarse map.
  void paint_coarse(const Cells& cells, float disparity_px) {
    const int cells_of_pixel = coarse.factor / 4;
    for (int y = cells.top / cells_of_pixel; y < cells.bottom / cells_of_pixel && y < coarse.disparity.height(); ++y) {
      for (int x = cells.left / cells_of_pixel; x < cells.right / cells_of_pixel && x < coarse.disparity.width(); ++x) {
        coarse.disparity(x, y) += disparity_px;
      }
    }
  }

 private:
  static constexpr int horizon = 96;  ///< first row below it
};

}  // namespace roadstereo::test

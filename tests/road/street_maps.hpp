#pragma once

#include <algorithm>
#include <limits>

#include "roadstereo/image.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"

namespace roadstereo::test {

/// A street that was matched as if there were nothing but its road, which has the disparity 0.25 (v − 95.5) below the
/// horizon, and something 3 pixels nearer than infinity above it; the coarse map of the scene shows the same. Residual
/// disparities of the road are 8 pixels from row 128 on. σ is 0.1 pixels, the correlation 0.9.
struct StreetMaps {
  Image<float> disparity, sigma, correlation;  ///< the last of cells of 4×4 pixels
  DisparityPrior scene;
  PerspectiveShift shift;

  StreetMaps(int width, int height, int factor)
      : disparity(width, height), sigma(width, height, 0.1F), correlation((width + 3) / 4, (height + 3) / 4, 0.9F) {
    constexpr float above_horizon = 3;
    shift.road = {-0.25 * 95.5, 0.25, 0};
    shift.delta_p = 8;
    shift.disparities = 16;
    scene.factor = factor;
    scene.disparity.resize(width / factor, height / factor);
    const auto road = [&](double v) { return static_cast<float>(std::max(0.0, shift.road.disparity(0, v))); };
    for (int v = 0; v < height; ++v) {
      std::fill_n(disparity.row(v), width, v < horizon ? above_horizon : road(v));
    }
    for (int y = 0; y < scene.disparity.height(); ++y) {
      const double v = factor * (y + 0.5) - 0.5;
      std::fill_n(scene.disparity.row(y), scene.disparity.width(),
                  v < horizon ? above_horizon : std::min(road(v), static_cast<float>(shift.delta_p)));
    }
  }

  struct Cells {
    int left, top, right, bottom;  ///< of 4×4 pixels; right and bottom excluded
  };
  Cells all() const { return {0, 0, correlation.width(), correlation.height()}; }

  /// The coarse search has found nothing.
  void forget_scene() { scene.disparity.assign(scene.disparity.width(), scene.disparity.height(), nan); }

  /// Adds to the map of the scene.
  void paint_scene(const Cells& cells, float disparity_px) {
    const int cells_of_pixel = scene.factor / 4;
    for (int y = cells.top / cells_of_pixel; y < cells.bottom / cells_of_pixel && y < scene.disparity.height(); ++y) {
      for (int x = cells.left / cells_of_pixel; x < cells.right / cells_of_pixel && x < scene.disparity.width(); ++x) {
        scene.disparity(x, y) += disparity_px;
      }
    }
  }

  void paint_sigma(const Cells& cells, float error, float rho) {
    for_pixels(cells, [&](int u, int v) { sigma(u, v) = error; });
    for (int j = cells.top; j < cells.bottom; ++j) {
      for (int i = cells.left; i < cells.right; ++i) correlation(i, j) = rho;
    }
  }

  /// Cells without a disparity.
  void paint_holes(const Cells& cells) {
    for_pixels(cells, [&](int u, int v) { disparity(u, v) = sigma(u, v) = nan; });
  }

  template <class Visit>
  void for_pixels(const Cells& cells, const Visit& visit) const {
    for (int v = 4 * cells.top; v < std::min(4 * cells.bottom, sigma.height()); ++v) {
      for (int u = 4 * cells.left; u < std::min(4 * cells.right, sigma.width()); ++u) visit(u, v);
    }
  }

  static constexpr int horizon = 96;  ///< first row below it
  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();
};

/// A corridor of holes that winds from the left border over the whole road, a thing that is not the road at its end,
/// and such things between its turns, which the road encloses. At least 320 columns and 300 rows.
struct Maze {
  StreetMaps maps;
  StreetMaps::Cells reached{}, enclosed{};  ///< cells of things that differ from the road at every coarse pixel around

  Maze(int width, int height) : maps(width, height, 4) {
    const int columns = maps.correlation.width(), rows = maps.correlation.height();
    const int middle = columns / 2, last = 34 + (rows - 34 - 12) / 12 * 12;
    bool to_right = true;
    for (int j = 34; j <= last; j += 12) {
      maps.paint_holes({j == 34 ? 0 : 3, j, columns - 3, j + 1});
      const int turn = to_right ? columns - 4 : 3;
      if (j < last) maps.paint_holes({turn, j, turn + 1, j + 13});
      to_right = !to_right;
      maps.paint_scene({middle - 10, j + 4, middle + 10, j + 9}, 30);
    }
    maps.paint_scene({middle - 10, last - 2, middle + 10, last + 3}, 30);
    reached = {middle - 6, last - 1, middle + 6, last + 2};
    enclosed = {middle - 10, 38, middle + 10, 43};
  }
};

}  // namespace roadstereo::test

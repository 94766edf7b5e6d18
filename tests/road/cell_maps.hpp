#pragma once

#include <algorithm>

#include "roadstereo/image.hpp"

namespace roadstereo::test {

/// Disparities, their standard errors and the correlation of cells of 4×4 pixels.
struct CellMaps {
  Image<float> disparity, sigma, correlation;

  CellMaps(int width, int height)
      : disparity(width, height, 10.0F), sigma(width, height), correlation((width + 3) / 4, (height + 3) / 4) {}

  struct Cells {
    int left, top, right, bottom;  ///< right and bottom excluded
  };

  void paint(const Cells& cells, float error, float rho) {
    for (int v = 4 * cells.top; v < std::min(4 * cells.bottom, sigma.height()); ++v) {
      for (int u = 4 * cells.left; u < std::min(4 * cells.right, sigma.width()); ++u) sigma(u, v) = error;
    }
    for (int j = cells.top; j < cells.bottom; ++j) {
      for (int i = cells.left; i < cells.right; ++i) correlation(i, j) = rho;
    }
  }
  void fill(float error, float rho) { paint({0, 0, correlation.width(), correlation.height()}, error, rho); }
};

/// A corridor of uncorrelated cells that winds from the left border through the whole map, and closed rooms between its
/// turns.
inline CellMaps maze(int width, int height) {
  CellMaps maps(width, height);
  maps.fill(0.6F, 1.0F);
  const int columns = maps.correlation.width(), rows = maps.correlation.height();
  bool to_right = true;
  for (int j = 2; j + 8 < rows; j += 6) {
    const int begin = j == 2 ? 0 : 3;
    maps.paint({begin, j, columns - 3, j + 3}, 0.6F, 0.0F);
    const int turn = to_right ? columns - 6 : 3;
    maps.paint({turn, j, turn + 3, j + 7}, 0.6F, 0.0F);
    maps.paint({columns / 2, j + 4, columns / 2 + 5, j + 5}, 0.6F, 0.0F);
    to_right = !to_right;
  }
  return maps;
}

}  // namespace roadstereo::test

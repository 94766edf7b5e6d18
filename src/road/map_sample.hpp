#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

// What the road geometry takes of a disparity map, on the host and on the device.
namespace roadstereo {

/// Points that the robust solver and the standard error look at: enough for both, few enough to cost nothing.
inline constexpr int sample_limit = 6000;

/// Residuals of neighbours are not independent: the standard error takes cells of the map as one observation each,
/// larger than the reach of the refinement's last pass (24 pixels).
inline constexpr int cells_per_side = 8;

/// A regular grid of pixels of a map, row by row.
struct MapSample {
  int step;
  int columns;
  int rows;

  ROADSTEREO_HD int count() const { return columns * rows; }
  /// Pixel of the i-th column or row.
  ROADSTEREO_HD int at(int i) const { return step / 2 + i * step; }
};

/// Of a map of width × height pixels: at most about `sample_limit` places.
inline MapSample map_sample(int width, int height) {
  const int root = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(width) * height / sample_limit)));
  const int step = root > 1 ? root : 1;
  const auto along = [step](int size) { return size > step / 2 ? (size - step / 2 + step - 1) / step : 0; };
  return {step, along(width), along(height)};
}

/// The column or row of cells that a pixel lies in.
ROADSTEREO_HD inline int cell_of(double at, int size) {
  return static_cast<int>(at * cells_per_side / size);
}
/// The same of a pixel in whole numbers: a quotient in double precision is never rounded up to one that it is below.
ROADSTEREO_HD inline int cell_of(int at, int size) {
  return at * cells_per_side / size;
}

/// What is left of a fit to tell how good it is. Deviations are from the weighted means.
struct FitMoments {
  double n;                             ///< weight of all points
  double uu, uv, vv;                    ///< weighted sums of products of deviations
  double residuals;                     ///< the same of the residuals' squares
  double score_uu, score_uv, score_vv;  ///< sums over the cells of products of their scores
  double bend, bend_variance;           ///< bend.hpp: pixels per pixel², and its variance
};

}  // namespace roadstereo

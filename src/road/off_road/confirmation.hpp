#pragma once

#include <cstdint>
#include <cstring>

#include "core/shifted_road.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

// What confirms or contradicts the disparities of a cell of 4×4 pixels, for the host and for kernels. C++17.

namespace roadstereo {

/// Cells to either side whose standard errors count.
constexpr int confirmation_radius = 4;

/// Sum of logarithms of standard errors, and the number of them.
struct LogSigmas {
  int sum = 0;  ///< of log2 σ / pixel, 1/256
  int count = 0;

  ROADSTEREO_HD void add(const LogSigmas& other) {
    sum += other.sum;
    count += other.count;
  }
  ROADSTEREO_HD void subtract(const LogSigmas& other) {
    sum -= other.sum;
    count -= other.count;
  }
};

/// log2 σ in 1/256: the bits of a float are its logarithm within 0.09, and whole numbers give one sum in any order. A
/// pixel without a disparity counts as 3 pixels.
ROADSTEREO_HD inline int log_sigma(float sigma) {
  constexpr float without_disparity = 3;
  constexpr int mantissa_bits = 23, fraction_bits = 8, exponent_bias = 127;
  const float known = sigma == sigma ? sigma : without_disparity;
  std::int32_t bits = 0;
  memcpy(&bits, &known, sizeof bits);
  return (bits >> (mantissa_bits - fraction_bits)) - (exponent_bias << fraction_bits);
}

/// Whether the pictures confirm a cell whose surroundings have these standard errors and this correlation.
ROADSTEREO_HD inline bool is_confirmed(const LogSigmas& sigmas, float correlation, float log2_max_sigma) {
  constexpr float log2_of_3 = 1.5849625F, steps = 256;
  const float mean = static_cast<float>(sigmas.sum) / (steps * static_cast<float>(sigmas.count));
  return mean <= log2_max_sigma + log2_of_3 * (correlation - 1);
}

/// A coarse map of residual disparities of all that a pair shows, and the shift that they are residuals of.
struct CoarseScene {
  ImageView<const float> residual;
  int factor;  ///< a pixel of the map covers factor × factor pixels of the image
  PerspectiveShift shift;
};

/// Sum of the residual disparities of pixels that have one, and their number.
struct ResidualSum {
  float sum = 0;
  int count = 0;

  /// A pixel in column u of a row whose shifts are `line`.
  ROADSTEREO_HD void add(float disparity, const RowLine& line, int u) {
    const bool known = disparity == disparity;
    sum += known ? without_shift(disparity, line, u) : 0.0F;
    count += known ? 1 : 0;
  }
  ROADSTEREO_HD void add(const ResidualSum& other) {
    sum += other.sum;
    count += other.count;
  }
  ROADSTEREO_HD float mean() const { return sum / static_cast<float>(count); }  ///< NaN of none
};

/// States of a cell.
enum CellState : std::uint8_t {
  on_road = 0,       ///< its disparity is that of the road, and that of the scene
  plausible = 1,     ///< nothing speaks against it
  unconfirmed = 2,   ///< not is_confirmed
  contradicted = 3,  ///< the scene has another disparity there
  masked = 8,        ///< has masked pixels: not known
};
/// Added to the state of a cell that cells on the road do not enclose.
constexpr int outside = 4;

ROADSTEREO_HD inline bool is_within(float difference, float tolerance) {
  return difference > -tolerance && difference < tolerance;
}

/// Coarse pixels to either side that may confirm a cell at the height of the road: blocks of the coarse search that
/// cover an edge take the disparity of its nearer side, above all along the row.
struct Around {
  int columns, rows;
};

/// Compares the mean residual disparity of a cell with the coarse map, whose resolution is half a coarse pixel. Above
/// the horizon, where the fine search has no road to fall back on, agreement confirms whatever the standard error.
ROADSTEREO_HD inline CellState assess_cell(const CoarseScene& scene, float residual, bool confirmed, int i, int j) {
  constexpr Around if_confirmed{2, 1}, if_unconfirmed{1, 0}, off_road{0, 0};
  constexpr float resolution = 0.5F, road_thickness = 1.0F / 3;  // coarse pixels, to either side
  constexpr double centre = 0.5 * (alignment_cell - 1);
  const CellState otherwise = confirmed ? plausible : unconfirmed;
  const ImageView<const float>& map = scene.residual;
  if (residual != residual) return otherwise;
  const auto factor = static_cast<float>(scene.factor);
  const auto road =
      static_cast<float>(shifted_road(scene.shift, i * alignment_cell + centre, j * alignment_cell + centre, -1.0));
  const bool above_horizon = road < 0;
  const bool near_road = !above_horizon && is_within(residual - road, road_thickness * factor);
  const int x = i * alignment_cell / scene.factor, y = j * alignment_cell / scene.factor;
  const Around around = !near_road ? off_road : confirmed ? if_confirmed : if_unconfirmed;
  bool known = false;
  for (int b = y > around.rows ? y - around.rows : 0; b <= y + around.rows && b < map.height(); ++b) {
    for (int a = x > around.columns ? x - around.columns : 0; a <= x + around.columns && a < map.width(); ++a) {
      const float found = map(a, b);
      if (found != found) continue;
      known = true;
      if (is_within(found - residual, resolution * factor))
        return near_road ? on_road : above_horizon ? plausible : otherwise;
    }
  }
  return known ? contradicted : otherwise;
}

/// Whether cell (i, j) is rejected, after the flood fill. Neighbours of a contradicted cell are rejected, too, since
/// the edge of an object was matched wrongly there.
ROADSTEREO_HD inline bool is_rejected(ImageView<const CellState> states, int i, int j) {
  const int state = states(i, j);
  if (state < outside || state == masked) return false;
  if (state != outside + plausible) return true;
  for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < states.height(); ++y) {
    for (int x = i > 0 ? i - 1 : 0; x <= i + 1 && x < states.width(); ++x) {
      if (states(x, y) == outside + contradicted) return true;
    }
  }
  return false;
}

}  // namespace roadstereo

#pragma once

#include <cstdint>

#include "core/shifted_road.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/off_road/confirmation.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

// Consistency of a cell of 4×4 pixels with a coarse disparity map of the whole scene, for the host and for kernels.
// C++17.

namespace roadstereo {

/// What the coarse map says of a cell.
enum class CellEvidence : std::uint8_t {
  unknown,       ///< nothing: it, or the cell, has no disparity there
  consistent,    ///< the same disparity
  on_road,       ///< the same disparity, which is that of the road
  contradicted,  ///< another disparity
};

/// The coarse map, of residual disparities, and the shift that they are residuals of.
struct CoarseScene {
  ImageView<const float> residual;
  int factor;  ///< a pixel of the map covers factor × factor pixels of the image
  PerspectiveShift shift;
};

/// Mean residual disparity of a cell; NaN where no pixel has one.
ROADSTEREO_HD inline float cell_residual(ImageView<const float> disparity, const PerspectiveShift& shift, int i,
                                         int j) {
  float sum = 0;
  int count = 0;
  for (int v = j * alignment_cell; v < (j + 1) * alignment_cell && v < disparity.height(); ++v) {
    const RowLine line = shift_line(shift, v);
    for (int u = i * alignment_cell; u < (i + 1) * alignment_cell && u < disparity.width(); ++u) {
      const float d = disparity(u, v);
      if (d != d) continue;
      sum += without_shift(d, line, u);
      ++count;
    }
  }
  return sum / static_cast<float>(count);
}

ROADSTEREO_HD inline bool is_within(float difference, float tolerance) {
  return difference > -tolerance && difference < tolerance;
}

/// Compares the mean residual disparity of a cell with the coarse map: half a coarse pixel is its resolution. Of a
/// cell at the height of the road the coarse pixels around it count, too, above all along the row: blocks of the coarse
/// search that cover an edge take the disparity of its nearer side.
ROADSTEREO_HD inline CellEvidence assess_consistency(const CoarseScene& scene, float residual, int i, int j) {
  constexpr int columns_around = 4, rows_around = 1;
  constexpr float resolution = 0.5F, road_thickness = 1.0F / 3;  // coarse pixels, to either side
  constexpr double centre = 0.5 * (alignment_cell - 1);
  const ImageView<const float>& map = scene.residual;
  if (residual != residual) return CellEvidence::unknown;
  const auto factor = static_cast<float>(scene.factor);
  const auto road =
      static_cast<float>(shifted_road(scene.shift, i * alignment_cell + centre, j * alignment_cell + centre, -1.0));
  const bool near_road = road >= 0 && is_within(residual - road, road_thickness * factor);
  const int x = i * alignment_cell / scene.factor, y = j * alignment_cell / scene.factor;
  const int dx = near_road ? columns_around : 0, dy = near_road ? rows_around : 0;
  bool known = false;
  for (int b = y - dy < 0 ? 0 : y - dy; b <= y + dy && b < map.height(); ++b) {
    for (int a = x - dx < 0 ? 0 : x - dx; a <= x + dx && a < map.width(); ++a) {
      const float found = map(a, b);
      if (found != found) continue;
      known = true;
      if (is_within(found - residual, resolution * factor)) {
        return near_road ? CellEvidence::on_road : CellEvidence::consistent;
      }
    }
  }
  return known ? CellEvidence::contradicted : CellEvidence::unknown;
}

/// Whether cell (i, j) is rejected: `state` is off_road outside of what cells on the road enclose. What lies beside a
/// contradicted cell is, too, unless it is on the road: the edge of a thing that was matched wrongly.
template <class Evidence, class State>
ROADSTEREO_HD bool is_contradicted(const Evidence& evidence, const State& state, int i, int j, int columns, int rows) {
  if (state(i, j) != off_road || evidence(i, j) == CellEvidence::on_road) return false;
  for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < rows; ++y) {
    for (int x = i > 0 ? i - 1 : 0; x <= i + 1 && x < columns; ++x) {
      if (state(x, y) == off_road && evidence(x, y) == CellEvidence::contradicted) return true;
    }
  }
  return false;
}

}  // namespace roadstereo

#pragma once

#include <optional>

#include "damage/cells.hpp"

namespace roadstereo {

/// Position of each cell on the road, and the change of ℓ' per unit of height there.
struct SurfaceCoordinates {
  /// Metres on the road, up to an affine map without a calibration, NaN where there is no road; without a plane −1 … 1
  /// over the image.
  Image<float> x, y;
  bool is_on_road = false;  ///< x and y are those of the plane of the road
  bool is_metric = false;   ///< x and y are metres
  Image<float> scale;  ///< pixels of ℓ' per metre of height, without a calibration below a camera of 1.5 m; else 1

  /// Width of the road in a column of cells over its length in a row, at most 1: how low what lies on it is in the
  /// image. 1 seen from above, and where it is unknown.
  double aspect(int i, int j) const;
};

/// Coordinates from the plane and the calibration, which is assumed where it is not given; without a plane of the
/// image.
SurfaceCoordinates surface_coordinates(const Cells& cells, const DamageInput& input, int threads);

/// Undamaged road: a quadratic in the coordinates of the road, times `scale`. A plane does not fit a camber.
struct RoadSurface {
  Image<float> value;  ///< ℓ' of the road at each cell, pixels; NaN where there is no road
  double noise = 0;    ///< robust standard deviation of the cells around it, pixels
};

/// Density of the regular sample that a fit uses: about 1500 or 6000 cells.
enum class Sampling { coarse, fine };

/// Fit the road surface by iteratively reweighted least squares (IRLS) with Tukey weights to a coarse sample, first a
/// plane, then a quadratic. Starts from the shorth of the values, the shortest interval that contains a third of them.
/// Throws Error when fewer than 32 samples are valid.
RoadSurface fit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates, int threads);

/// Refit the quadratic by IRLS to the cells where `region` is not 0, starting from an earlier fit. Throws likewise.
RoadSurface refit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                               const Image<std::uint8_t>& region, const RoadSurface& earlier, Sampling sampling,
                               int threads);

}  // namespace roadstereo

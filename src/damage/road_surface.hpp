#pragma once

#include <optional>

#include "damage/cells.hpp"

namespace roadstereo {

/// Where each cell lies on the road, and what one unit of height there does to ℓ'.
struct SurfaceCoordinates {
  Image<float> x, y;   ///< metres on the road when calibrated, else shares of the image; NaN where there is no road
  Image<float> scale;  ///< pixels of ℓ' for a metre of height when calibrated, else 1
};

/// From the plane and the calibration when both are there, else from the image alone.
SurfaceCoordinates surface_coordinates(const Cells& cells, const DamageInput& input);

/// The undamaged road, a quadratic of the road's coordinates: a plane cannot follow a camber.
struct RoadSurface {
  Image<float> value;  ///< ℓ' of the road at each cell, pixels; NaN where there is no road
  double noise = 0;    ///< standard deviation of the cells around it, pixels, robust
};

/// How many cells a fit looks at: the first fits only say where the road is.
enum class Sampling { rough, fine };

/// Rough robust fit (Tukey's weights) to the cells near the value that most of them have.
/// Throws Error when fewer than 32 cells can be used.
RoadSurface fit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates);

/// The same to the cells of `region` (0 = leave out), from an earlier fit on.
RoadSurface refit_road_surface(const Cells& cells, const SurfaceCoordinates& coordinates,
                               const Image<std::uint8_t>& region, const RoadSurface& earlier, Sampling sampling);

}  // namespace roadstereo

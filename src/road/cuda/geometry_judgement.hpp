#pragma once

#include "road/cuda/road_fit_figures.hpp"
#include "road/raw_sums.hpp"
#include "roadstereo/road_geometry.hpp"

namespace roadstereo::cuda {

/// The rest of fit_road_geometry() with the robust solver, on the host: what the figures of RoadFit::run say of a map
/// of width × height pixels. Throws the same errors.
RoadGeometry finish_road_fit(const RoadFitFigures& figures, int width, int height, const RoadGeometryOptions& options);

/// The other solvers, from the sums of MapSums: plane, roll angle and iterations. Throws the same errors. The rest
/// follows from RoadFit::measure of that plane.
RoadGeometry solve_map(const RawSums& sums, int width, int height, double initial_roll_rad,
                       const RoadGeometryOptions& options);

/// Fills in the rest, from the figures of RoadFit::measure.
void finish_measured(const RoadFitFigures& figures, int width, int height, const RoadGeometryOptions& options,
                     RoadGeometry& geometry);

}  // namespace roadstereo::cuda

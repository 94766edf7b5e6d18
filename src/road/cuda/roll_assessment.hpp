#pragma once

#include "road/cuda/road_fit_statistics.hpp"
#include "road/raw_sums.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cuda {

/// The rest of estimate_roll() with the robust solver, on the host: what the statistics of RoadFit::run say of a map
/// of width × height pixels. Throws the same errors.
RollEstimate finish_road_fit(const RoadFitStatistics& statistics, int width, int height, const RollOptions& options);

/// The other solvers, from the sums of MapSums: plane, roll angle and iterations. Throws the same errors. The rest
/// follows from RoadFit::measure of that plane.
RollEstimate solve_map(const RawSums& sums, int width, int height, double initial_roll_rad, const RollOptions& options);

/// Fills in the rest, from the statistics of RoadFit::measure.
void finish_measured(const RoadFitStatistics& statistics, int width, int height, const RollOptions& options,
                     RollEstimate& geometry);

}  // namespace roadstereo::cuda

#pragma once

#include "road/cuda/road_fit_statistics.hpp"
#include "road/cuda/solved_map.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cuda {

/// The rest of estimate_roll() with the robust solver, on the host: what the statistics of RoadFit::run say of a map
/// of width × height pixels. Throws the same errors.
RollEstimate finish_road_fit(const RoadFitStatistics& statistics, int width, int height, const RollOptions& options);

/// The same of the other solvers, from what MapSums has solved and RoadFit::measure has measured.
RollEstimate finish_solved(const SolvedMap& solved, const RoadFitStatistics& measured, int width, int height,
                           const RollOptions& options);

}  // namespace roadstereo::cuda

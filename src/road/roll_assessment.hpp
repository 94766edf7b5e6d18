#pragma once

#include "road/map_sample.hpp"
#include "road/plane_fit.hpp"
#include "road/roll_energy.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo {

/// Throws Error when `points` disparities are too few for a road geometry.
void require_enough(double points);

/// Throws Error: the disparities have no area.
[[noreturn]] void fail_on_one_line();

/// What the solvers that take all disparities find: plane, roll angle and iterations. Throws as above.
RollEstimate solve_from_sums(const PlaneSums& sums, double initial_roll_rad, const RollOptions& options);

/// RollOptions of the solvers that take all disparities.
RollFromSums roll_from_sums(double initial_roll_rad, const RollOptions& options);

/// What such a solver has found on `points` disparities. Throws as above.
RollEstimate take_solved(const SolvedRoll& solved, double points);

/// Fills in what follows from plane, roll angle and the moments of the fit to a map of width × height pixels.
void assess_roll(const FitMoments& moments, int width, int height, const RollOptions& options, RollEstimate& geometry);

}  // namespace roadstereo

#pragma once

#include <optional>

#include "road/map_sample.hpp"
#include "road/plane_fit.hpp"
#include "road/roll_energy.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo {

/// Error of disparities that determine no road geometry: too few, or all on one line of the image.
class NoRoadGeometry : public Error {
 public:
  using Error::Error;
};

/// The road geometry that `fit` returns; nothing if it throws NoRoadGeometry.
template <class Fit>
std::optional<RollEstimate> geometry_if_determined(const Fit& fit) {
  try {
    return fit();
  } catch (const NoRoadGeometry&) {
    return std::nullopt;
  }
}

/// Throws NoRoadGeometry when `points` disparities are too few.
void require_enough(double points);

/// Throws NoRoadGeometry: the disparities have no area.
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

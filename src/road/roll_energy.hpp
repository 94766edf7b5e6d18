#pragma once

#include "road/plane_fit.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo {

/// The energy E_t min(ψ) of eq. (23) as a function of the roll angle alone, in closed form from ten sums over the
/// map: E(ψ) = S_dd − S_yd² / S_yy with y(ψ) = v cos ψ − u sin ψ (eq. (19)).
class RollEnergy {
 public:
  explicit RollEnergy(const PlaneSums& sums) : sums_(sums) {}

  double value(double roll) const;
  double gradient(double roll) const;  ///< eq. (26)
  double alpha1(double roll) const;    ///< eq. (21)
  double alpha0(double roll) const;

  /// What the energy is divided by for the descent, so that λ(0) means the same for any map: the curvature at ψ = 0 of
  /// a road without roll becomes 1/10, for which λ = 10 is Newton's step.
  double normaliser() const;

 private:
  double yy(double roll) const;
  double yd(double roll) const;

  PlaneSums sums_;
};

/// What a solver returns.
struct RollSolution {
  double roll = 0;
  int iterations = 0;
};

/// Eq. (25) with the learning rate of eq. (28).
RollSolution descend_roll(const RollEnergy& energy, double initial_roll, const RollOptions& options);

/// The same minimum from the least-squares plane: ψ = atan(−a2 / a1).
double roll_of_plane(const DisparityPlane& plane);

/// The same angle in (−π/2, π/2]: the energy repeats after π.
double wrap_roll(double roll);

}  // namespace roadstereo

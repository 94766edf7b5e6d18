#pragma once

#include <cmath>

#include "road/raw_sums.hpp"
#include "road/robust_weights.hpp"
#include "roadstereo/disparity_plane.hpp"

// The roll angle as the minimum of the energy E_t min(ψ), eq. (23), on the host and on the device.
namespace roadstereo {

/// The energy as a function of the roll angle alone, in closed form from ten sums over the map:
/// E(ψ) = S_dd − S_yd² / S_yy with y(ψ) = v cos ψ − u sin ψ (eq. (19)).
class RollEnergy {
 public:
  ROADSTEREO_HD explicit RollEnergy(const DeviationSums& sums) : sums_(sums) {}

  ROADSTEREO_HD double value(double roll) const {
    const Direction at(roll);
    return sums_.dd - yd(at) * yd(at) / yy(at);
  }

  /// Eq. (26).
  ROADSTEREO_HD double gradient(double roll) const {
    const Direction at(roll);
    const double yd_slope = -at.s * sums_.vd - at.c * sums_.ud;
    const double yy_slope = 2 * at.c * at.s * (sums_.uu - sums_.vv) - 2 * (at.c * at.c - at.s * at.s) * sums_.uv;
    const double alpha = yd(at) / yy(at);
    return -2 * alpha * yd_slope + alpha * alpha * yy_slope;
  }

  /// Eq. (21).
  ROADSTEREO_HD double alpha1(double roll) const {
    const Direction at(roll);
    return yd(at) / yy(at);
  }
  ROADSTEREO_HD double alpha0(double roll) const {
    const Direction at(roll);
    return sums_.mean_d - yd(at) / yy(at) * (sums_.mean_v * at.c - sums_.mean_u * at.s);
  }

  /// What the energy is divided by for the descent, so that λ(0) means the same for any map: the curvature at ψ = 0 of
  /// a road without roll becomes 1/10, for which λ = 10 is Newton's step.
  ROADSTEREO_HD double normaliser() const { return 20 * sums_.dd * sums_.uu / sums_.vv; }

 private:
  struct Direction {
    ROADSTEREO_HD explicit Direction(double roll) : c(std::cos(roll)), s(std::sin(roll)) {}
    double c, s;
  };

  ROADSTEREO_HD double yy(const Direction& at) const {
    return at.c * at.c * sums_.vv - 2 * at.c * at.s * sums_.uv + at.s * at.s * sums_.uu;
  }
  ROADSTEREO_HD double yd(const Direction& at) const { return at.c * sums_.vd - at.s * sums_.ud; }

  DeviationSums sums_;
};

inline constexpr double half_turn = 3.14159265358979323846;

/// The same angle in (−π/2, π/2]: the energy repeats after π.
ROADSTEREO_HD inline double wrap_roll(double roll) {
  const double wrapped = std::remainder(roll, half_turn);
  return wrapped <= -half_turn / 2 ? wrapped + half_turn : wrapped;
}

/// The minimum of the energy from the least-squares plane: ψ = atan(−a2 / a1).
ROADSTEREO_HD inline double roll_of_plane(const DisparityPlane& plane) {
  if (plane.a1 == 0) return plane.a2 == 0 ? 0 : half_turn / 2;
  return std::atan(-plane.a2 / plane.a1);
}

/// Of the descent: RollOptions.
struct DescentOptions {
  double initial_lambda, roll_threshold_rad;
  int max_iterations;
};

/// What a solver returns.
struct RollSolution {
  double roll = 0;
  int iterations = 0;
};

/// Eq. (25) with the learning rate of eq. (28).
ROADSTEREO_HD inline RollSolution descend_roll(const RollEnergy& energy, double initial_roll,
                                               const DescentOptions& options) {
  const double max_step = half_turn / 8;
  const double normaliser = energy.normaliser();
  RollSolution solution{initial_roll, 0};
  if (!(normaliser > 0)) return solution;
  double lambda = options.initial_lambda;
  double gradient = energy.gradient(solution.roll) / normaliser;
  while (solution.iterations < options.max_iterations) {
    ++solution.iterations;
    const double wished = -lambda * gradient;
    double step = wished > max_step ? max_step : wished < -max_step ? -max_step : wished;
    if (std::fabs(step) < options.roll_threshold_rad &&
        energy.value(solution.roll) > energy.value(solution.roll + half_turn / 2)) {
      step = max_step;  // at the maximum the gradient vanishes as well
    }
    // Backtracking: a step that climbs is halved.
    while (energy.value(solution.roll + step) > energy.value(solution.roll) &&
           std::fabs(step) >= options.roll_threshold_rad) {
      step /= 2;
    }
    const double next_gradient = energy.gradient(solution.roll + step) / normaliser;
    solution.roll += step;
    // Eq. (28). The rate of the step as taken, which the bounds above may have changed, enters it; where the
    // energy is concave the quotient is no rate at all and the initial one serves again.
    const double taken = gradient != 0 ? -step / gradient : lambda;
    const double quotient = taken * gradient / (gradient - next_gradient);
    lambda = std::isfinite(quotient) && quotient > 0 ? quotient : options.initial_lambda;
    gradient = next_gradient;
    if (std::fabs(step) < options.roll_threshold_rad) break;
  }
  solution.roll = wrap_roll(solution.roll);
  return solution;
}

/// How the roll angle is solved for from the sums over a map.
struct RollFromSums {
  bool descend;  ///< from `initial_roll_rad`; else in closed form
  double initial_roll_rad;
  DescentOptions descent;
};

/// The model that a solver finds. The plane comes first, so that its address serves as that of a plane.
struct SolvedRoll {
  DisparityPlane plane;
  double roll_rad;
  int iterations;
  int found;  ///< 0: all points lie on one line of the image, or there are none
};

/// Plane, roll angle and iterations from the sums over a map.
ROADSTEREO_HD inline SolvedRoll solve_roll(const DeviationSums& sums, const RollFromSums& how) {
  DisparityPlane least_squares{};
  if (!solve_slopes({sums.n, sums.uu, sums.uv, sums.vv, sums.ud, sums.vd}, true, least_squares.a1, least_squares.a2)) {
    return {least_squares, 0, 0, 0};
  }
  const RollEnergy energy(sums);
  RollSolution solution{roll_of_plane(least_squares), 1};
  if (how.descend) solution = descend_roll(energy, how.initial_roll_rad, how.descent);
  const double alpha1 = energy.alpha1(solution.roll);
  return {{energy.alpha0(solution.roll), alpha1 * std::cos(solution.roll), -alpha1 * std::sin(solution.roll)},
          solution.roll,
          solution.iterations,
          1};
}

}  // namespace roadstereo

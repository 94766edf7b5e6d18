#include "road/roll_energy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadstereo {

double RollEnergy::yy(double roll) const {
  const double c = std::cos(roll), s = std::sin(roll);
  return c * c * sums_.vv() - 2 * c * s * sums_.uv() + s * s * sums_.uu();
}

double RollEnergy::yd(double roll) const {
  return std::cos(roll) * sums_.vd() - std::sin(roll) * sums_.ud();
}

double RollEnergy::value(double roll) const {
  return sums_.dd() - yd(roll) * yd(roll) / yy(roll);
}

double RollEnergy::gradient(double roll) const {
  const double c = std::cos(roll), s = std::sin(roll);
  const double yd_slope = -s * sums_.vd() - c * sums_.ud();
  const double yy_slope = 2 * c * s * (sums_.uu() - sums_.vv()) - 2 * (c * c - s * s) * sums_.uv();
  const double alpha = alpha1(roll);
  return -2 * alpha * yd_slope + alpha * alpha * yy_slope;
}

double RollEnergy::alpha1(double roll) const {
  return yd(roll) / yy(roll);
}

double RollEnergy::alpha0(double roll) const {
  const double mean_y = sums_.mean_v() * std::cos(roll) - sums_.mean_u() * std::sin(roll);
  return sums_.mean_d() - alpha1(roll) * mean_y;
}

double RollEnergy::normaliser() const {
  return 20 * sums_.dd() * sums_.uu() / sums_.vv();
}

double wrap_roll(double roll) {
  constexpr double pi = std::numbers::pi;
  const double wrapped = std::remainder(roll, pi);
  return wrapped <= -pi / 2 ? wrapped + pi : wrapped;
}

double roll_of_plane(const DisparityPlane& plane) {
  if (plane.a1 == 0) return plane.a2 == 0 ? 0 : std::numbers::pi / 2;
  return std::atan(-plane.a2 / plane.a1);
}

RollSolution descend_roll(const RollEnergy& energy, double initial_roll, const RollOptions& options) {
  constexpr double max_step = std::numbers::pi / 8;
  const double normaliser = energy.normaliser();
  RollSolution solution{initial_roll, 0};
  if (!(normaliser > 0)) return solution;
  const auto slope = [&](double roll) { return energy.gradient(roll) / normaliser; };

  double lambda = options.initial_lambda;
  double gradient = slope(solution.roll);
  while (solution.iterations < options.max_iterations) {
    ++solution.iterations;
    double step = std::clamp(-lambda * gradient, -max_step, max_step);
    if (std::abs(step) < options.roll_threshold_rad &&
        energy.value(solution.roll) > energy.value(solution.roll + std::numbers::pi / 2)) {
      step = max_step;  // at the maximum the gradient vanishes as well
    }
    // Backtracking: a step that climbs is halved.
    while (energy.value(solution.roll + step) > energy.value(solution.roll) &&
           std::abs(step) >= options.roll_threshold_rad) {
      step /= 2;
    }
    const double next_gradient = slope(solution.roll + step);
    solution.roll += step;
    // Eq. (28). The rate of the step as taken, which the bounds above may have changed, enters it; where the
    // energy is concave the quotient is no rate at all and the initial one serves again.
    const double taken = gradient != 0 ? -step / gradient : lambda;
    const double quotient = taken * gradient / (gradient - next_gradient);
    lambda = std::isfinite(quotient) && quotient > 0 ? quotient : options.initial_lambda;
    gradient = next_gradient;
    if (std::abs(step) < options.roll_threshold_rad) break;
  }
  solution.roll = wrap_roll(solution.roll);
  return solution;
}

}  // namespace roadstereo

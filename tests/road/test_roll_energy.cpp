// The roll energy from ten sums against the paper's matrices, built in full for small maps.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "road/roll_assessment.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

const DescentOptions descent = roll_from_sums(0, RollOptions{}).descent;

struct SmallMap {
  std::vector<DisparityPoint> points;
  PlaneSums sums;
};

SmallMap small_map(const DisparityPlane& plane, double noise) {
  SmallMap map;
  for (int i = 0; i < 60; ++i) {
    const double u = std::floor(64 * test::lattice(i, 0, 3)), v = std::floor(48 * test::lattice(i, 1, 3));
    map.points.push_back({u, v, plane.disparity(u, v) + noise * (test::lattice(i, 2, 3) - 0.5)});
    map.sums.add(map.points.back());
  }
  return map;
}

/// E_t min(ψ) = dᵀd − dᵀY(YᵀY)⁻¹Yᵀd (eq. (23)) with Y = [1 y(ψ)] written out.
double energy_by_matrices(const SmallMap& map, double psi) {
  double n = 0, y1 = 0, y2 = 0, dd = 0, d1 = 0, dy = 0;
  for (const DisparityPoint& p : map.points) {
    const double y = p.v * std::cos(psi) - p.u * std::sin(psi);
    n += 1;
    y1 += y;
    y2 += y * y;
    dd += p.d * p.d;
    d1 += p.d;
    dy += p.d * y;
  }
  const double det = n * y2 - y1 * y1;
  return dd - (d1 * (y2 * d1 - y1 * dy) + dy * (n * dy - y1 * d1)) / det;
}

/// −2 dᵀW(ψ)d (eqs. (26), (27)) with W = (I − YJ)∇YJ: ∇Y = [0 −x(ψ)], J d = α.
double gradient_by_matrices(const SmallMap& map, double psi) {
  double n = 0, y1 = 0, y2 = 0, d1 = 0, dy = 0;
  const auto y_of = [psi](const DisparityPoint& p) { return p.v * std::cos(psi) - p.u * std::sin(psi); };
  const auto x_of = [psi](const DisparityPoint& p) { return p.u * std::cos(psi) + p.v * std::sin(psi); };
  for (const DisparityPoint& p : map.points) {
    n += 1;
    y1 += y_of(p);
    y2 += y_of(p) * y_of(p);
    d1 += p.d;
    dy += p.d * y_of(p);
  }
  const double det = n * y2 - y1 * y1;
  const double alpha0 = (y2 * d1 - y1 * dy) / det, alpha1 = (n * dy - y1 * d1) / det;
  double product = 0;  // (d − Yα)ᵀ ∇Y α
  for (const DisparityPoint& p : map.points) product += (p.d - alpha0 - alpha1 * y_of(p)) * (-x_of(p) * alpha1);
  return -2 * product;
}

TEST(RollEnergy, MatchesMatricesOfPaper) {
  const SmallMap map = small_map({5, 0.2, -0.03}, 1.0);
  const RollEnergy energy(map.sums.deviations());
  for (double psi = -1.5; psi <= 1.5; psi += 0.25) {
    EXPECT_NEAR(energy.value(psi), energy_by_matrices(map, psi), 1e-8);
    EXPECT_NEAR(energy.gradient(psi), gradient_by_matrices(map, psi), 1e-8);
  }
}

TEST(RollEnergy, GradientIsNumericalDerivative) {
  const RollEnergy energy(small_map({5, 0.2, -0.03}, 1.0).sums.deviations());
  for (double psi = -1.5; psi <= 1.5; psi += 0.25) {
    constexpr double h = 1e-5;
    EXPECT_NEAR(energy.gradient(psi), (energy.value(psi + h) - energy.value(psi - h)) / (2 * h), 1e-5);
  }
}

TEST(RollDescent, ReachesClosedFormFromAnyStart) {
  for (const double roll : {-1.2, -0.35, -0.02, 0.0, 0.001, 0.2, 0.9}) {
    for (const double noise : {0.0, 0.5, 3.0}) {
      const double alpha1 = 0.25;
      const SmallMap map = small_map({3, alpha1 * std::cos(roll), -alpha1 * std::sin(roll)}, noise);
      const auto plane = map.sums.plane();
      ASSERT_TRUE(plane);
      for (const double start : {0.0, 0.1, -0.5, 1.4}) {
        const RollSolution solution = descend_roll(RollEnergy(map.sums.deviations()), start, descent);
        EXPECT_NEAR(wrap_roll(solution.roll - roll_of_plane(*plane)), 0, 1e-6) << roll << " " << noise << " " << start;
        EXPECT_LE(solution.iterations, 60);
      }
    }
  }
}

TEST(RollDescent, LeavesMaximumOfZeroGradient) {
  PlaneSums symmetric;  // a full grid: the energy is highest at exactly π/2
  for (int v = 0; v < 20; ++v) {
    for (int u = 0; u < 30; ++u) symmetric.add({static_cast<double>(u), static_cast<double>(v), 3 + 0.25 * v});
  }
  const RollSolution solution = descend_roll(RollEnergy(symmetric.deviations()), std::numbers::pi / 2, descent);
  EXPECT_NEAR(solution.roll, 0, 1e-6);
}

// λ(0) = 10 is Newton's step for a road without roll whatever the number of pixels, so a small roll takes few steps.
TEST(RollDescent, InitialLambdaIsIndependentOfMapSize) {
  for (const int scale : {1, 2, 4}) {
    PlaneSums sums;
    for (int v = 0; v < 36 * scale; ++v) {
      for (int u = 0; u < 64 * scale; ++u) {
        sums.add({static_cast<double>(u), static_cast<double>(v), 3 + 0.25 * v - 0.002 * u});
      }
    }
    const RollSolution solution = descend_roll(RollEnergy(sums.deviations()), 0, descent);
    EXPECT_NEAR(solution.roll, std::atan(0.002 / 0.25), 1e-6);
    EXPECT_LE(solution.iterations, 4);
  }
}

TEST(WrapRoll, IsHalfOpen) {
  constexpr double half = std::numbers::pi / 2;
  EXPECT_NEAR(wrap_roll(half), half, 1e-15);
  EXPECT_NEAR(wrap_roll(-half), half, 1e-15);
  EXPECT_NEAR(wrap_roll(3.0), 3.0 - std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace roadstereo

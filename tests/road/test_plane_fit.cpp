// Planes through points of disparity space: exact recovery, and robustness against what lies on and beside a road.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/order_statistics.hpp"
#include "road/plane_fit.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr DisparityPlane truth{-40.5, 0.31, -0.012};

std::vector<DisparityPoint> points_on(const DisparityPlane& plane, int count) {
  std::vector<DisparityPoint> points;
  for (int i = 0; i < count; ++i) {
    const double u = 1200 * test::lattice(i, 0, 5), v = 200 + 170 * test::lattice(i, 1, 5);
    points.push_back({u, v, plane.disparity(u, v)});
  }
  return points;
}

TEST(PlaneSums, RecoverExactPlane) {
  PlaneSums sums(600, 250);
  for (const DisparityPoint& p : points_on(truth, 500)) sums.add(p);
  const auto plane = sums.plane();
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->a0, truth.a0, 1e-9);
  EXPECT_NEAR(plane->a1, truth.a1, 1e-12);
  EXPECT_NEAR(plane->a2, truth.a2, 1e-12);
}

TEST(PlaneSums, WithoutRollFitLineOverRows) {
  // Points on two rows: the line goes through the two means.
  PlaneSums sums;
  sums.add({0, 100, 10});
  sums.add({50, 100, 12});
  sums.add({0, 200, 20});
  sums.add({50, 200, 24});
  const auto plane = sums.plane(false);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->a1, (22.0 - 11.0) / 100, 1e-12);
  EXPECT_NEAR(plane->a0, 0, 1e-9);
  EXPECT_EQ(plane->a2, 0);
}

TEST(PlaneSums, CollinearPointsGiveNoPlane) {
  PlaneSums sums;
  for (int i = 0; i < 20; ++i) sums.add({static_cast<double>(i), 2.0 * i, 3.0});
  EXPECT_FALSE(sums.plane());
  EXPECT_FALSE(PlaneSums().plane());
}

TEST(IrlsPlaneFit, IgnoresThirdOfOutliers) {
  auto points = points_on(truth, 3000);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].d += 2 + 30 * test::lattice(static_cast<int>(i), 7, 5);
  const auto fit = fit_plane_irls(points, {truth.a0 + 0.4, truth.a1, truth.a2}, 0.6, true, 100);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->plane.disparity(0, 200), truth.disparity(0, 200), 1e-6);
  EXPECT_NEAR(fit->plane.disparity(1200, 370), truth.disparity(1200, 370), 1e-6);
}

TEST(IrlsPlaneFit, ScaleIsSigmaOfNormalNoise) {
  auto points = points_on(truth, 20000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double sum = 0;  // twelve uniform numbers: normal to a percent
    for (int k = 0; k < 12; ++k) sum += test::lattice(static_cast<int>(i), 10 + k, 5);
    points[i].d += 0.3 * (sum - 6);
  }
  const auto fit = fit_plane_irls(points, truth, 0.6, true, 100);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->scale_px, 0.3, 0.01);
}

TEST(IrlsPlaneFit, CountsItsSteps) {
  auto points = points_on(truth, 3000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].d += test::lattice(static_cast<int>(i), 7, 5);
  const DisparityPlane start{truth.a0 + 0.4, truth.a1, truth.a2};
  for (const int most : {1, 2}) EXPECT_EQ(fit_plane_irls(points, start, 0.6, true, most)->iterations, most);
}

TEST(SearchPlane, FindsPlaneOfMajority) {
  auto points = points_on(truth, 2000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 5 < 2) points[i].d = 100 * test::lattice(static_cast<int>(i), 3, 5);
  }
  const auto plane = ransac_plane(points, 0.5);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->disparity(600, 300), truth.disparity(600, 300), 0.5);
}

/// Of five points two lie on the plane, two on one a pixel higher at one side, one anywhere above.
TEST(LeastQuantile, IsPlaneOfTwoFifths) {
  std::vector<DisparityPoint> points = points_on(truth, 1000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    DisparityPoint& p = points[i];
    if (i % 5 == 1) p.d += 40 * test::lattice(static_cast<int>(i), 2, 5);
    if (i % 5 > 2) p.d += 1 + 0.0005 * p.u + 0.1 * test::lattice(static_cast<int>(i), 3, 5);
    if (i % 11 == 0) p.d = std::numeric_limits<double>::quiet_NaN();
  }
  const QuantilePlane found = least_quantile_plane(points, {-39.8, 0.31, -0.0115});
  EXPECT_NEAR(found.plane.a0, truth.a0, 1e-9);
  EXPECT_NEAR(found.plane.a1, truth.a1, 1e-9);
  EXPECT_NEAR(found.plane.a2, truth.a2, 1e-9);
  EXPECT_NEAR(found.quantile_px, 0, 1e-5);
}

/// Of two exact planes the lower one, though it has fewer points.
TEST(LeastQuantile, PrefersLowerOfTwoPlanes) {
  std::vector<DisparityPoint> points = points_on(truth, 1000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].d += i % 5 < 3 ? 1.4 : 0;
  const QuantilePlane found = least_quantile_plane(points, {truth.a0 + 1.4, truth.a1, truth.a2});
  EXPECT_NEAR(found.plane.a0, truth.a0, 1e-9);
}

/// Of residuals spread evenly over ±1 px a share c lies within c px, and (1 − c) / 2 below: of the true plane c is a
/// half where it is a quarter and what lies below. Of a plane three quarters lower, with nothing below, it is a
/// quarter.
TEST(LeastQuantile, KeepsStartThatIsBest) {
  std::vector<DisparityPoint> points = points_on(truth, 3000);
  EXPECT_EQ(least_quantile_plane(points, truth).plane.a0, truth.a0);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].d += 2 * test::lattice(static_cast<int>(i), 4, 5) - 1;
  EXPECT_GT(least_quantile_plane(points, truth).quantile_px, 0.2);
  EXPECT_LT(least_quantile_plane(points, truth).quantile_px, 0.55);
  const std::vector<DisparityPoint> missing(50, {1, 2, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(least_quantile_plane(missing, truth).plane.a1, truth.a1);
}

}  // namespace
}  // namespace roadstereo

// The evidence of a pixel against the formula in double precision; planes found where single blocks cannot decide,
// where most of the picture is something else, and not found where there is no road.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "road/plane_evidence.hpp"
#include "road/row_correlation.hpp"
#include "roadstereo/road_model.hpp"
#include "tests/core/every_target.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

using DisparityEvidenceTarget = test::EveryTarget;

TEST_P(DisparityEvidenceTarget, MatchesPosteriorByHand) {
  constexpr int width = 21, disparities = 9, pitch = 48, column = 18;
  std::vector<float> values(static_cast<std::size_t>(disparities * pitch), -1.0f);
  const std::vector<double> rho{0.1, -0.3, 0.2, 0.4, 0.9, 0.5, 0.0, 0.3};  // the last disparity has no counterpart
  for (std::size_t d = 0; d < rho.size(); ++d) values[d * pitch + column] = static_cast<float>(rho[d]);
  values[5 * pitch + width] = 0.99f;  // beyond the image
  std::vector<float> memory(static_cast<std::size_t>(disparities * evidence_columns));
  std::vector<float> support(disparities, 0.0f), beyond(disparities, 0.0f);
  add_evidence({values.data(), pitch, width, disparities}, 16, memory.data(), {support.data(), beyond.data()});

  std::vector<double> posterior(disparities, 0.0);
  double total = 0;
  for (std::size_t d = 0; d < rho.size(); ++d) {
    const double positive = std::max(rho[d], 0.0);
    total += posterior[d] = std::pow(1 - positive * positive, -6);
  }
  double cumulative = 0;
  const double n = static_cast<double>(rho.size());
  for (std::size_t d = 0; d < disparities; ++d) {
    const double before = d > 0 ? posterior[d - 1] : 0, after = d + 1 < posterior.size() ? posterior[d + 1] : 0;
    const double ratio = (0.5 * posterior[d] + 0.25 * (before + after)) / total * n;
    cumulative += posterior[d] / total;
    const double chance = std::min(static_cast<double>(d + 1), n) / n;
    EXPECT_NEAR(support[d], d < rho.size() ? 3.2 * (ratio - 1) / (ratio + 6) : 0.0, 1e-4) << d;
    EXPECT_NEAR(beyond[d], std::max(0.0, cumulative - chance), 1e-5) << d;
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, DisparityEvidenceTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

/// Largest difference of a plane to d(u, v) in the corners of a box.
template <class Disparity>
double max_difference(const DisparityPlane& plane, const Disparity& d, int left, int right, int top, int bottom) {
  double worst = 0;
  for (const int v : {top, bottom}) {
    for (const int u : {left, right}) worst = std::max(worst, std::abs(plane.disparity(u, v) - d(u, v)));
  }
  return worst;
}

TEST(PlaneEvidence, FindsRoadBetweenObstacles) {
  // House fronts and parked cars on either side: the road is the lower middle, a fifth of the picture.
  constexpr int width = 400, height = 240;
  const auto road = [](double u, double v) { return 0.2 * (v - 90) + 0.004 * (u - 200); };
  const auto scene = [&](double u, double v) {
    const double horizon = 100;
    if (u > 130 && u < 290 && v > horizon + 20) return road(u, v);
    return std::max(u < 200 ? 26.0 : 22.0, road(u, v) + 1);
  };
  const auto pair = test::textured_pair(width, height, scene);
  const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 130, 290, 120, height - 1), 1.0);
}

TEST(PlaneEvidence, FindsRoadInNoiseThatHidesBlocks) {
  constexpr int width = 640, height = 360;
  const auto road = [](double u, double v) { return 6 + 0.05 * v - 0.003 * u; };
  auto pair = test::textured_pair(width, height, road, 7, 0.08);  // texture of 3 grey levels under noise of 6
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto noisy = [&](std::int16_t grey, std::uint64_t seed) {
        double sum = 0;
        for (std::uint64_t i = 0; i < 4; ++i) sum += test::lattice(u, v, seed + i) - 0.5;
        return static_cast<std::int16_t>(std::clamp(grey + sum * 10 * grey_scale, 0.0, double{grey_max}));
      };
      pair.reference(u, v) = noisy(pair.reference(u, v), 100);
      pair.target(u, v) = noisy(pair.target(u, v), 200);
    }
  }
  const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 0, width - 1, 0, height - 1), 0.5);
}

TEST(PlaneEvidence, WallsAreNoRoad) {
  constexpr int width = 400, height = 240;
  for (const double slope : {0.12, -0.12}) {  // a house front to one side: the disparity changes along the columns
    const auto wall = [slope](double u, double) { return 36 + slope * (u - 200); };
    const auto pair = test::textured_pair(width, height, wall);
    const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
    EXPECT_EQ(found.status, RoadStatus::none);
    EXPECT_FALSE(found.reason.empty());
  }
}

TEST(PlaneEvidence, UpsideDownIsNoRoad) {
  constexpr int width = 400, height = 240;
  const auto ceiling = [](double, double v) { return 0.25 * (height - v); };
  const auto pair = test::textured_pair(width, height, ceiling);
  EXPECT_EQ(estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{}).status,
            RoadStatus::none);
}

TEST(TrackedRoad, IsFoundAgainWhereItIsThirdOfPicture) {
  constexpr int width = 400, height = 240;
  const auto scene = [](double moved) {
    return [moved](double u, double v) {
      const double road = 0.2 * (v - 90) + moved;
      return u > 130 && u < 290 ? std::max(road, 0.5) : std::max(24.0, road + 8);
    };
  };
  const auto before = test::textured_pair(width, height, scene(0)), now = test::textured_pair(width, height, scene(1.5));
  const RoadModelEstimate found =
      estimate_road_model(before.reference, before.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  const RoadModelEstimate tracked =
      verify_road_model(now.reference, now.target, {found.model, found.inlier_share}, std::nullopt, RoadModelOptions{});
  EXPECT_EQ(tracked.status, RoadStatus::tracked) << tracked.reason;
  EXPECT_NEAR(tracked.model.disparity(200, 200), 0.2 * 110 + 1.5, 0.3);
  // The same inliers of a road that was all of the picture before are not enough.
  const RoadModelEstimate lost =
      verify_road_model(now.reference, now.target, {found.model, 1.0}, std::nullopt, RoadModelOptions{});
  EXPECT_EQ(lost.status, RoadStatus::none);
}

}  // namespace
}  // namespace roadstereo

// The evidence of a pixel against the formula in double precision; planes found where single blocks cannot decide,
// where most of the picture is something else, and not found where there is no road.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "road/line_sums.hpp"
#include "road/masked_blocks.hpp"
#include "road/plane_evidence.hpp"
#include "road/rig_prior.hpp"
#include "road/row_correlation.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
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
    const double missing = std::max(0.0, cumulative - chance) / std::max(0.05, 1 - chance);
    EXPECT_NEAR(beyond[d], missing * missing, 1e-5) << d;
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, DisparityEvidenceTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

using LineSumsTarget = test::EveryTarget;

// Numbers that are exact in single precision: lines that leave the image at either end, and more than fill a vector.
TEST_P(LineSumsTarget, MatchesSumOverRows) {
  constexpr int rows = 13, disparities = 21, count = 37, row_step = 2;
  std::vector<float> values(static_cast<std::size_t>(rows) * disparities);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * 7) % 31) - 11;
  std::vector<float> steps(count + line_sums_guard, 0.0F), sums(count + line_sums_guard);
  for (int k = 0; k < count; ++k) steps[static_cast<std::size_t>(k)] = 0.125F * static_cast<float>(k - 14);
  for (const float bottom : {0.25F, 9.75F, 20.0F}) {
    sum_along_lines({values.data(), rows, disparities}, bottom, steps.data(), count, row_step, sums.data());
    for (int k = 0; k < count; ++k) {
      double expected = 0;
      for (int above = 0; above < rows; above += row_step) {
        const double d = std::floor(double{bottom} - above * 0.125 * (k - 14) + 0.5);
        if (d < 1 || d >= disparities) continue;
        expected +=
            double{values[static_cast<std::size_t>((rows - 1 - above) * disparities) + static_cast<std::size_t>(d)]};
      }
      EXPECT_EQ(sums[static_cast<std::size_t>(k)], expected) << "from " << bottom << ", line " << k;
    }
  }
}

// A plane that leaves the disparities at either end, and more rows than fill a vector.
TEST_P(LineSumsTarget, PlaneIsInterpolatedInEveryCell) {
  constexpr int rows = 19, columns = 5, disparities = 12;
  std::vector<float> values(static_cast<std::size_t>(rows) * columns * disparities);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * 7) % 31) - 11;
  for (const float first : {-2.25F, 3.5F, 9.0F}) {
    for (const float row_step : {-0.25F, 0.0F, 0.5F}) {
      for (const float column_step : {-1.0F, 0.75F}) {
        double expected = 0;
        for (int r = 0; r < rows; ++r) {
          for (int c = 0; c < columns; ++c) {
            const double d = double{first} + double{row_step} * r + double{column_step} * c;
            if (d <= 0 || d >= disparities - 1) continue;
            const double whole = std::floor(d);
            const auto at = static_cast<std::size_t>((r * columns + c) * disparities) + static_cast<std::size_t>(whole);
            expected += (whole + 1 - d) * double{values[at]} + (d - whole) * double{values[at + 1]};
          }
        }
        EXPECT_EQ(sum_along_plane({values.data(), rows, columns, disparities}, first, row_step, column_step), expected)
            << first << ", " << row_step << ", " << column_step;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, LineSumsTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

/// Largest difference of a plane to d(u, v) in the corners of a box.
template <class Disparity>
double max_difference(const DisparityPlane& plane, const Disparity& d, int left, int right, int top, int bottom) {
  double worst = 0;
  for (const int v : {top, bottom}) {
    for (const int u : {left, right}) {
      const double error = std::abs(plane.disparity(u, v) - d(u, v));
      if (std::isnan(error) || error > worst) worst = error;
    }
  }
  return worst;
}

std::array<double, 3> numbers(const DisparityPlane& plane) {
  return {plane.a0, plane.a1, plane.a2};
}

/// House fronts and parked cars on either side: the road is the lower middle, a fifth of the picture.
test::TexturedPair street(int width, int height, const std::function<double(double, double)>& road) {
  return test::textured_pair(width, height, [&road](double u, double v) {
    const double horizon = 100;
    if (u > 130 && u < 290 && v > horizon + 20) return road(u, v);
    return std::max(u < 200 ? 26.0 : 22.0, road(u, v) + 1);
  });
}

TEST(PlaneEvidence, FindsRoadBetweenObstacles) {
  constexpr int width = 400, height = 240;
  const auto road = [](double u, double v) { return 0.2 * (v - 90) + 0.004 * (u - 200); };
  const auto pair = street(width, height, road);
  const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 130, 290, 120, height - 1), 1.0);
}

// What stands in front of a road says nothing about it. Where it counts against the road, a plane through the obstacles
// has more evidence than the tenth of the picture that the road is.
TEST(PlaneEvidence, ObstaclesDoNotSpeakAgainstRoad) {
  constexpr int width = 400, height = 240, left = 155, right = 225;
  const auto road = [](double u, double v) { return 0.2 * (v - 90) + 0.004 * (u - 200); };
  const auto parked = [](double u, double) { return u < 60 ? 30.0 : u < 130 ? 25.0 : u < 280 ? 22.0 : 31.0; };
  const auto lane_between_fronts = [](double u, double) { return 34 - 0.08 * std::abs(u - 190); };
  for (const std::function<double(double, double)>& obstacles :
       {std::function<double(double, double)>(parked), std::function<double(double, double)>(lane_between_fronts)}) {
    const auto pair = test::textured_pair(width, height, [&](double u, double v) {
      return u > left && u < right && v > 112 ? road(u, v) : std::max(obstacles(u, v), road(u, v) + 1);
    });
    const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
    ASSERT_NE(found.status, RoadStatus::none) << found.reason;
    EXPECT_LT(max_difference(found.model, road, left, right, 125, height - 1), 1.5);
  }
}

TEST(PlaneEvidence, MaskedPixelsTakeNoPart) {
  constexpr int width = 400, height = 240, bonnet = 180;
  const auto road = [](double u, double v) { return 4 + 0.1 * v - 0.004 * u; };
  auto pair = test::textured_pair(width, height, road);
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = bonnet; v < height; ++v) std::fill_n(mask.row(v), width, std::uint8_t{255});
  const auto find = [&] {
    return estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{}, 0, mask);
  };
  const RoadModelEstimate first = find();
  ASSERT_NE(first.status, RoadStatus::none) << first.reason;
  EXPECT_LT(max_difference(first.model, road, 0, width - 1, 0, bonnet), 0.3);
  const auto track = [&] {
    return verify_road_model(pair.reference, pair.target, {first.model, first.inlier_share}, std::nullopt,
                             RoadModelOptions{}, 0, mask);
  };
  const RoadModelEstimate tracked = track();
  // Whatever the masked pixels show, the road is the same to the bit.
  for (int v = bonnet; v < height; ++v) {
    for (int u = 0; u < width; ++u) pair.reference(u, v) = static_cast<std::int16_t>((u * 131 + v * 71) % grey_max);
  }
  EXPECT_EQ(numbers(find().model), numbers(first.model));
  EXPECT_EQ(find().evidence, first.evidence);
  EXPECT_EQ(numbers(track().model), numbers(tracked.model));
}

TEST(MaskedBlocks, AreThoseThatContainMaskedPixel) {
  constexpr int width = 53, height = 41;
  Image<std::uint8_t> mask(width, height, 0);
  for (const auto& [u, v] : {std::pair{5, 7}, {30, 20}, {31, 20}, {52, 40}}) mask(u, v) = 255;
  for (const int factor : {1, 2, 4}) {
    const MaskedBlocks masked(mask, factor);
    for (int v = 1; v + 1 < height / factor; ++v) {
      for (int u = 2; u + 2 < width / factor; ++u) {
        bool expected = false;
        for (int y = (v - 1) * factor; y < (v + 2) * factor; ++y) {
          for (int x = (u - 2) * factor; x < (u + 3) * factor; ++x) expected = expected || mask(x, y) != 0;
        }
        EXPECT_EQ(masked.contains(u, v, 2, 1), expected) << factor << ": " << u << ", " << v;
      }
    }
  }
  EXPECT_FALSE(MaskedBlocks().contains(5, 5, 2, 2));
}

TEST(RigPrior, HalvesWeightAtTolerance) {
  const StereoCalibration rig{700, 320, 180, 0.5, 0, 640, 360};
  // 1.5 m above a road 10° below the axis: d = baseline / height · (cos · (v − cy) + sin · f).
  const double pitch = 10 * std::acos(-1.0) / 180;
  const auto plane = [&](double height_m) {
    const double scale = rig.baseline_m / height_m;
    return DisparityPlane{scale * (std::sin(pitch) * rig.focal_px - std::cos(pitch) * rig.cy_px),
                          scale * std::cos(pitch), 0};
  };
  RoadModelOptions options;
  EXPECT_EQ(RigPrior(options, std::nullopt).weight(plane(1.5)), 1);
  options.height_m = 1.5;
  EXPECT_THROW(RigPrior(options, std::nullopt), Error);
  EXPECT_NEAR(RigPrior(options, rig).weight(plane(1.5)), 1, 1e-9);
  EXPECT_NEAR(RigPrior(options, rig).weight(plane(1.2 * 1.5)), 0.5, 1e-9);
  EXPECT_EQ(RigPrior(options, rig).disagreement(plane(1.19 * 1.5)), "");
  EXPECT_NE(RigPrior(options, rig).disagreement(plane(3)).find("3 m above the road"), std::string::npos);
  options = {};
  options.pitch_deg = 15;
  EXPECT_NEAR(RigPrior(options, rig).weight(plane(1.5)), 0.5, 1e-9);
  options.pitch_deg = 16;
  EXPECT_NE(RigPrior(options, rig).disagreement(plane(1.5)).find("pitch"), std::string::npos);
}

TEST(RigPrior, OrdersPlanesOfLikeEvidence) {
  constexpr int width = 400, height = 240, factor = 2, max_planes = 3;
  const StereoCalibration rig{400, 200, 120, 0.3, 0, width, height};
  const auto pair = street(width, height, [](double u, double v) { return 0.2 * (v - 90) + 0.004 * (u - 200); });
  const PlaneEvidence evidence(match_coarsely(pair.reference, pair.target, factor, 140, 0));
  const TiltLimit limit(width, height, rig, 30);
  RoadModelOptions options;
  const auto search = [&] {
    const RigPrior prior(options, rig);
    return search_planes(
               evidence, limit, [&](const DisparityPlane& plane) { return prior.weight(plane); }, road_max_slope,
               max_planes, 0)
        .roads;
  };
  const auto planes = search();
  ASSERT_GE(planes.size(), 2U);
  const GroundPlane second = ground_plane(planes[1].plane, rig);
  options.height_m = second.height_m;
  options.pitch_deg = second.pitch_rad * 180 / std::acos(-1.0);
  const auto weighed = search();
  // The local search may start elsewhere.
  const auto second_plane = [&](double u, double v) { return planes[1].plane.disparity(u, v); };
  EXPECT_LT(max_difference(weighed.front().plane, second_plane, 0, width - 1, 0, height - 1), 1.0);
  EXPECT_GT(max_difference(planes[0].plane, second_plane, 0, width - 1, 0, height - 1), 5.0);
  EXPECT_NEAR(weighed.front().evidence, planes[1].evidence, 0.01);
}

TEST(WeightNear, HalvesWhereTrackingLosesTheRoad) {
  constexpr int width = 640, height = 360;
  constexpr double lost_px = 0.7 * 4;      // of the search around the last plane
  const DisparityPlane last{-10, 0.1, 0};  // 25.9 px at the lower border, no road above row 100
  const auto weight = [&](const DisparityPlane& plane) { return weight_near(plane, last, 0, width, height); };
  EXPECT_EQ(weight(last), 1);
  EXPECT_NEAR(weight({-10 + lost_px, 0.1, 0}), 0.5, 1e-9);
  EXPECT_NEAR(weight({-10 - lost_px / 2, 0.1, 0}), 0.8, 1e-9);
  EXPECT_NEAR(weight({-10, 0.1, lost_px / (width - 1)}), 0.5, 1e-9);
  EXPECT_EQ(weight({40, 0.1, 0}), 0.1);
}

/// Texture of 3 grey levels under noise of 6.
test::TexturedPair noisy_pair(int width, int height, const std::function<double(double, double)>& road) {
  auto pair = test::textured_pair(width, height, road, 7, 0.08);
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
  return pair;
}

TEST(PlaneEvidence, FindsRoadInNoiseThatHidesBlocks) {
  constexpr int width = 640, height = 360;
  const auto road = [](double u, double v) { return 6 + 0.05 * v - 0.003 * u; };
  const auto pair = noisy_pair(width, height, road);
  const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 0, width - 1, 0, height - 1), 0.5);
}

TEST(TrackedRoad, IsFoundAgainInNoiseThatHidesBlocks) {
  constexpr int width = 640, height = 360;
  const auto road = [](double u, double v) { return 8 + 0.05 * v - 0.003 * u; };
  const auto pair = noisy_pair(width, height, road);
  const TrackedRoad last{{6.5, 0.051, -0.003}, 0.3};
  const RoadModelEstimate by_blocks =
      verify_road_model(pair.reference, pair.target, last, std::nullopt, RoadModelOptions{});
  EXPECT_EQ(by_blocks.status, RoadStatus::none);
  const RoadModelEstimate tracked =
      verify_road_model_in_noise(pair.reference, pair.target, last, std::nullopt, RoadModelOptions{});
  ASSERT_EQ(tracked.status, RoadStatus::tracked) << tracked.reason;
  EXPECT_LT(max_difference(tracked.model, road, 0, width - 1, 0, height - 1), 0.5);
  EXPECT_TRUE(tracked.samples_are_cells);
  // Farther than the search can see the road has jumped.
  const TrackedRoad far{{20, 0.05, -0.003}, 0.3};
  EXPECT_EQ(verify_road_model_in_noise(pair.reference, pair.target, far, std::nullopt, RoadModelOptions{}).status,
            RoadStatus::none);
}

TEST(TiltLimit, PoseWeightFollowsTiltAndHeight) {
  const StereoCalibration rig{700, 320, 180, 0.5, 0, 640, 360};
  const double pitch = 0.3;
  for (const auto& [degrees, height] :
       {std::pair{0.0, 1.7}, std::pair{4.0, 1.7}, std::pair{-10.0, 0.5}, std::pair{25.0, 0.3}, std::pair{0.0, 10.0}}) {
    const double roll = degrees * std::acos(-1.0) / 180;
    // Normal of the road in the camera: the sine of its tilt is its part along the columns.
    const double nx = std::sin(roll), ny = std::cos(roll) * std::cos(pitch), nz = std::cos(roll) * std::sin(pitch);
    const double scale = rig.baseline_m / height;
    const DisparityPlane plane{scale * (nz * rig.focal_px - ny * rig.cy_px - nx * rig.cx_px), scale * ny, scale * nx};
    const double sigmas = std::sin(roll) / (0.33 * std::sin(30 * std::acos(-1.0) / 180));
    EXPECT_NEAR(TiltLimit(640, 360, rig, 30).pose_weight(plane), std::exp(-0.5 * sigmas * sigmas) / (1 + scale * scale),
                1e-9)
        << degrees << "°, " << height << " m";
  }
  // 2 m high, the horizon in row 288: below it lie 71 of 359 rows, two thirds of three tenths.
  const double scale = rig.baseline_m / 2, depth = scale * (180 - 288) / rig.focal_px;
  EXPECT_NEAR(TiltLimit(640, 360, rig, 30).pose_weight({-scale * 288, scale, 0}),
              71 / 359.0 / 0.3 / (1 + scale * scale + depth * depth), 1e-9);
}

/// Level planes a baseline and ten baselines below the camera: ½ and 1/1.01 of the evidence count.
TEST(RoadAssessment, WhatMayBeABonnetNeedsMoreEvidence) {
  const StereoCalibration rig{700, 320, 180, 0.2, 0, 640, 360};
  const TiltLimit limit(640, 360, rig, 30);
  const auto status = [&](double baselines, double evidence) {
    PlaneFitStatistics fit;
    fit.plane = {-180 / baselines, 1 / baselines, 0};
    fit.points = fit.inliers = 1000;
    fit.found = true;
    fit.rows_covered = 0.4;
    RoadModelEstimate estimate;
    assess_found_road(fit, evidence, limit, RoadModelOptions{}, estimate);
    return estimate.status;
  };
  EXPECT_EQ(status(10, 0.0607), RoadStatus::weak);
  EXPECT_EQ(status(10, 0.0605), RoadStatus::none);
  EXPECT_EQ(status(1, 0.119), RoadStatus::none);
  EXPECT_EQ(status(1, 0.121), RoadStatus::weak);
}

TEST(PlaneEvidence, LevelRoadIsTakenBeforeTiltedFront) {
  constexpr int width = 400, height = 240;
  const auto road = [](double, double v) { return 0.15 * (v - 60); };
  // A row of parked vehicles fills more of the picture than the road beside it.
  const auto pair = test::textured_pair(width, height, [&road](double u, double v) {
    const double front = 16 + 0.1 * v - 0.06 * u;
    return u < 240 ? std::max(front, road(u, v)) : std::max(road(u, v), 1.0);
  });
  const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  ASSERT_NE(found.status, RoadStatus::none) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 250, width - 1, 90, height - 1), 1.0);
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

// The road above, and below it fronts, or one that leans back as a road does.
TEST(PlaneEvidence, UpsideDownStreetIsDoubted) {
  constexpr int width = 400, height = 240;
  const auto find = [](const auto& below) {
    const auto pair = test::textured_pair(width, height,
                                          [&](double u, double v) { return v < 130 ? 0.25 * (150 - v) : below(u, v); });
    return estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
  };
  const RoadModelEstimate fronts = find([](double u, double) { return u < 120 ? 8.0 : u < 260 ? 5.0 : 7.0; });
  EXPECT_NE(fronts.status, RoadStatus::found);
  EXPECT_NE(fronts.reason.find("upside down"), std::string::npos) << fronts.reason;
  const RoadModelEstimate leaning = find([](double, double v) { return 5 + 0.03 * (v - 130); });
  EXPECT_NE(leaning.status, RoadStatus::found);
}

TEST(PlaneEvidence, FindsRoadOfTunnel) {
  constexpr int width = 400, height = 240;
  const auto road = [](double, double v) { return 0.25 * (v - 120); };
  const auto tunnel = test::textured_pair(width, height, [&road](double u, double v) {
    return std::max({road(u, v), 0.25 * (120 - v), 3.0});
  });
  const RoadModelEstimate found =
      estimate_road_model(tunnel.reference, tunnel.target, std::nullopt, RoadModelOptions{});
  ASSERT_EQ(found.status, RoadStatus::found) << found.reason;
  EXPECT_LT(max_difference(found.model, road, 0, width - 1, 150, height - 1), 1.0);
}

TEST(TrackedRoad, IsFoundAgainWhereItIsThirdOfPicture) {
  constexpr int width = 400, height = 240;
  const auto scene = [](double moved) {
    return [moved](double u, double v) {
      const double road = 0.2 * (v - 90) + moved;
      return u > 130 && u < 290 ? std::max(road, 0.5) : std::max(24.0, road + 8);
    };
  };
  const auto before = test::textured_pair(width, height, scene(0)),
             now = test::textured_pair(width, height, scene(1.5));
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

TEST(TrackedRoad, ShareOfCellsAsksNothingOfBlocks) {
  const auto pair = test::textured_pair(400, 240, [](double u, double v) {
    const double road = 0.2 * (v - 90);
    return u > 130 && u < 290 ? std::max(road, 0.5) : std::max(24.0, road + 8);
  });
  TrackedRoad last{{-18, 0.2, 0}, 1.0};
  EXPECT_EQ(verify_road_model(pair.reference, pair.target, last, std::nullopt, RoadModelOptions{}).status,
            RoadStatus::none);
  last.samples_are_cells = true;
  EXPECT_EQ(verify_road_model(pair.reference, pair.target, last, std::nullopt, RoadModelOptions{}).status,
            RoadStatus::tracked);
}

TEST(PlaneEvidence, FindsRoadFarBelowDrone) {
  // Of 10 and 20 m, 700 px and 1400 px, 0.12 m: about a pixel of the downsampled image at the first search.
  for (const auto& [width, height, disparity] : {std::tuple{1280, 720, 8.4}, {1920, 1080, 8.4}, {1280, 720, 4.2}}) {
    const auto road = [d = disparity](double u, double v) { return d + 0.0004 * u + 0.0002 * v; };
    const auto pair = test::textured_pair(width, height, road);
    const RoadModelEstimate found = estimate_road_model(pair.reference, pair.target, std::nullopt, RoadModelOptions{});
    ASSERT_EQ(found.status, RoadStatus::found) << width << ", " << disparity << ": " << found.reason;
    EXPECT_LT(max_difference(found.model, road, 0, width - 1, 0, height - 1), 0.1) << width << ", " << disparity;
  }
}

}  // namespace
}  // namespace roadstereo

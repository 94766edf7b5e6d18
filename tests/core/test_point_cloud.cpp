// Points of a disparity map.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/point_cloud.hpp"

namespace roadstereo {
namespace {

StereoCalibration example_calibration() {
  StereoCalibration calibration;
  calibration.focal_px = 100;
  calibration.cx_px = 1;
  calibration.cy_px = 0;
  calibration.baseline_m = 0.1;
  calibration.disparity_offset_px = 2;
  return calibration;
}

/// f·b = 10: a disparity of 8 + 2 px is 1 m away, 0.02 px below zero of d + doffs is nowhere.
TEST(CloudFromDisparity, MatchesPointsByHand) {
  Image<float> disparity(3, 2, std::numeric_limits<float>::quiet_NaN());
  disparity(0, 0) = 8;      // 1 m
  disparity(2, 0) = 3;      // 2 m
  disparity(0, 1) = -2;     // d + doffs = 0
  disparity(1, 1) = -1.7F;  // 33 m: 0.3 px, less than the smallest
  disparity(2, 1) = std::numeric_limits<float>::infinity();
  Frame left{std::vector<std::uint8_t>(18), 3, 2, SampleType::u8, ChannelOrder::rgb};
  for (std::size_t i = 0; i < left.bytes.size(); ++i) left.bytes[i] = static_cast<std::uint8_t>(i);
  const PointCloud cloud = cloud_from_disparity(disparity, left.view(), 0, example_calibration());
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_NEAR(cloud.points[0][0], -0.01, 1e-7);
  EXPECT_NEAR(cloud.points[0][2], 1, 1e-6);
  EXPECT_NEAR(cloud.points[1][0], 0.02, 1e-7);
  EXPECT_NEAR(cloud.points[1][1], 0, 1e-7);
  EXPECT_NEAR(cloud.points[1][2], 2, 1e-6);
  EXPECT_EQ(cloud.colours[0], (std::array<std::uint8_t, 3>{0, 1, 2}));
  EXPECT_EQ(cloud.colours[1], (std::array<std::uint8_t, 3>{6, 7, 8}));
  EXPECT_THROW(cloud_from_disparity(Image<float>(2, 2, 1.0F), left.view(), 0, example_calibration()), Error);
}

/// Without a left image, and with one of 16 bits: grey, 12 bits white.
TEST(CloudFromDisparity, ColoursAreOptionalAndOfEightBits) {
  Image<float> disparity(2, 1, 8.0F);
  EXPECT_TRUE(cloud_from_disparity(disparity, example_calibration()).colours.empty());
  const std::vector<std::uint16_t> samples{4095, 803};
  const FrameView left = FrameView::grey16(samples.data(), 2, 1);
  const PointCloud cloud = cloud_from_disparity(disparity, left, 4095, example_calibration());
  for (const double white : {-5.0, std::nan(""), 65536.0}) {
    EXPECT_THROW(cloud_from_disparity(disparity, left, white, example_calibration()), Error) << white;
  }
  EXPECT_EQ(cloud.points, cloud_from_disparity(disparity, example_calibration()).points);
  EXPECT_EQ(cloud.colours[0], (std::array<std::uint8_t, 3>{255, 255, 255}));
  EXPECT_EQ(cloud.colours[1], (std::array<std::uint8_t, 3>{50, 50, 50}));  // 803·255 / 4095 = 50.004
  EXPECT_EQ(cloud_from_disparity(disparity, left, 1000, example_calibration()).colours[0][0], 255);
}

/// A road seen at a slant: its points lie at z = 0 on the road, and distances stay what they are.
TEST(ToRoadFrame, RoadIsLevel) {
  const StereoCalibration calibration = example_calibration();
  const DisparityPlane model{6, 0.11, 0.02};
  Image<float> disparity(40, 32);
  for (int v = 0; v < 32; ++v) {
    for (int u = 0; u < 40; ++u) disparity(u, v) = static_cast<float>(model.disparity(u, v));
  }
  const Frame left{std::vector<std::uint8_t>(40 * 32, 7), 40, 32, SampleType::u8, ChannelOrder::grey};
  const PointCloud cloud = cloud_from_disparity(disparity, left.view(), 0, calibration);
  const PointCloud level = to_road_axes(cloud, road_axes(ground_plane(model, calibration)));
  ASSERT_EQ(level.points.size(), 40U * 32U);
  EXPECT_EQ(level.colours, cloud.colours);
  const auto distance = [](const PointCloud& of, std::size_t i, std::size_t j) {
    const auto &a = of.points[i], &b = of.points[j];
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  for (std::size_t i = 0; i < level.points.size(); ++i) {
    EXPECT_NEAR(level.points[i][2], 0, 1e-6);
    EXPECT_NEAR(distance(level, i, 0), distance(cloud, i, 0), 1e-6);
  }
}

}  // namespace
}  // namespace roadstereo

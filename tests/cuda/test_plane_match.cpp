// The search around a supposed road on the device against the host's, place by place.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/downsample.hpp"
#include "road/cuda/plane_match.hpp"
#include "road/plane_match.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo::cuda {
namespace {

constexpr DisparityPlane road{6, 0.06, -0.03};

struct Found {
  std::vector<DisparityPoint> points;
  std::vector<float> correlations;
  int tried = 0;
};

Found search_on_device(const test::TexturedPair& pair, const DisparityPlane& plane, int range, int places,
                       const int* needed = nullptr, int factor = 1) {
  test::DevicePlane<std::int16_t> left(pair.reference), right(pair.target);
  const SampleGrid grid = sample_grid(pair.reference.width(), pair.reference.height(), range, places);
  const auto count = static_cast<std::size_t>(grid.places());
  DeviceArray<float> u(count), v(count), d(count), correlation(count);
  DeviceArray<int> tried(count);
  match_along_plane({left.view(), right.view(), factor}, grid, {nullptr, {plane.a0, plane.a1, plane.a2}}, needed,
                    {u.data(), v.data(), d.data(), correlation.data(), tried.data()}, nullptr);
  const auto us = test::to_host(u.data(), count), vs = test::to_host(v.data(), count),
             ds = test::to_host(d.data(), count);
  const auto cs = test::to_host(correlation.data(), count);
  const auto ts = test::to_host(tried.data(), count);
  Found found;
  for (std::size_t i = 0; i < count; ++i) {
    found.tried += ts[i];
    if (!std::isnan(cs[i])) found.correlations.push_back(cs[i]);
    if (!std::isnan(ds[i])) found.points.push_back({us[i], vs[i], ds[i]});
  }
  return found;
}

void expect_same(const Found& device, const PlaneMatches& host) {
  // Places whose texture or correlation lies at its threshold.
  const std::size_t max_missing = test::kernels_round_as_host ? 0 : 2;
  EXPECT_LE(std::abs(device.tried - host.tried), static_cast<int>(max_missing));
  std::size_t common = 0;
  for (const DisparityPoint& point : host.points) {
    const auto same = std::find_if(device.points.begin(), device.points.end(),
                                   [&](const DisparityPoint& p) { return p.u == point.u && p.v == point.v; });
    if (same == device.points.end()) continue;
    ++common;
    EXPECT_NEAR(same->d, point.d, 5e-5);
  }
  EXPECT_LE(host.points.size() - common, max_missing);
  EXPECT_LE(device.points.size() - common, max_missing);
  ASSERT_NEAR(static_cast<double>(device.correlations.size()), static_cast<double>(host.correlations.size()),
              static_cast<double>(max_missing));
  if (device.correlations.size() != host.correlations.size()) return;
  for (std::size_t i = 0; i < host.correlations.size(); ++i) {
    EXPECT_NEAR(device.correlations[i], host.correlations[i], 1e-4) << i;
  }
}

test::TexturedPair textured_road(int width, int height) {
  return test::textured_pair(width, height, [](double u, double v) { return road.disparity(u, v); });
}

class CudaGuidedMatch : public test::OnDevice {};

TEST_F(CudaGuidedMatch, MatchesHost) {
  for (const auto& [width, height] : {std::pair(129, 47), std::pair(161, 93)}) {
    const test::TexturedPair pair = textured_road(width, height);
    for (const int range : {2, 4, 7}) {
      SCOPED_TRACE(testing::Message() << width << "×" << height << ", range " << range);
      // Half a pixel off, rolled either way.
      for (const DisparityPlane& plane : {DisparityPlane{6.5, 0.06, -0.03}, DisparityPlane{5.2, 0.063, -0.024}}) {
        const auto host = match_along_plane(pair.reference, pair.target, plane, range, 120, 1);
        ASSERT_GT(host.points.size(), 40U);
        expect_same(search_on_device(pair, plane, range, 120), host);
      }
    }
  }
}

TEST_F(CudaGuidedMatch, FollowsOppositeRoll) {
  const DisparityPlane turned{2, 0.05, 0.06};
  const auto pair = test::textured_pair(129, 47, [&](double u, double v) { return turned.disparity(u, v); });
  const auto host = match_along_plane(pair.reference, pair.target, {2.3, 0.05, 0.06}, 4, 200, 1);
  ASSERT_GT(host.points.size(), 40U);
  expect_same(search_on_device(pair, {2.3, 0.05, 0.06}, 4, 200), host);
}

TEST_F(CudaGuidedMatch, LargeImageLiesOnRoad) {
  // The pair as the search sees it; what it stands for is twice as large.
  const test::TexturedPair pair = textured_road(129, 47);
  const DisparityPlane large{2 * (road.a0 - (road.a1 + road.a2) / 4), road.a1, road.a2};
  const Found found = search_on_device(pair, large, 2, 200, nullptr, 2);
  ASSERT_GT(found.points.size(), 50U);
  for (const DisparityPoint& p : found.points) EXPECT_NEAR(p.d, large.disparity(p.u, p.v), 0.3);
  const DisparityPoint& first = found.points.front();
  EXPECT_NEAR(first.v, to_full_resolution(plane_block_half_height, 2), 1e-6);
}

TEST_F(CudaGuidedMatch, RoadOutOfViewTriesNothing) {
  const test::TexturedPair pair = textured_road(129, 47);
  for (const DisparityPlane& plane :
       {DisparityPlane{-5, 0, 0}, DisparityPlane{6, 0.06, 0.6}, DisparityPlane{126, 0, 0}}) {
    const Found found = search_on_device(pair, plane, 4, 100);
    EXPECT_EQ(found.tried, match_along_plane(pair.reference, pair.target, plane, 4, 100, 1).tried);
    EXPECT_EQ(found.tried, 0);
    EXPECT_TRUE(found.points.empty());
  }
  const auto needed = test::to_device(std::vector{0});
  EXPECT_EQ(search_on_device(pair, road, 4, 100, needed.data()).tried, 0);
}

TEST_F(CudaGuidedMatch, SkipsSamplesWithoutTexture) {
  test::TexturedPair pair = textured_road(129, 47);
  for (int v = 0; v < 47; ++v) {
    for (int u = 40; u < 90; ++u) pair.reference(u, v) = 1000;
  }
  const auto host = match_along_plane(pair.reference, pair.target, road, 4, 300, 1);
  const Found found = search_on_device(pair, road, 4, 300);
  EXPECT_LT(found.tried, search_on_device(textured_road(129, 47), road, 4, 300).tried);
  expect_same(found, host);
}

}  // namespace
}  // namespace roadstereo::cuda

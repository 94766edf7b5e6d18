// What the links of a flight tell of shutters that roll, from links whose mean and standard error have a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "flight/rolling_shutter.hpp"
#include "tests/flight/alternating_links.hpp"

namespace roadstereo::cli {
namespace {

std::vector<FrameLink> rolling_links(double share, double noise) {
  return test::alternating_links(&FrameLink::shutter, &FrameLink::shutter_sd, share, noise);
}

std::map<int, double> times() {
  constexpr double period_s = 0.04;
  std::map<int, double> times;
  for (int i = 0; i <= test::link_count; ++i) times[i] = period_s * i;
  return times;
}

TEST(RollingShutter, IsMeanOfLinksInMilliseconds) {
  const auto finding = rolling_shutter(rolling_links(0.5, 0.1), times());
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->id, "rolling-shutter");
  EXPECT_EQ(finding->unit, "ms");
  EXPECT_NEAR(finding->value, 20, 1e-9);
  EXPECT_NEAR(finding->limit, 5 * 4 / std::sqrt(test::link_count - 1.0), 1e-9);
  EXPECT_NE(finding->text.find("the last row is exposed 20.00 ± 0.92 ms after the first"), std::string::npos)
      << finding->text;
  EXPECT_FALSE(finding->spoils_depth);
}

TEST(RollingShutter, IsInFramesWithoutTimes) {
  std::map<int, double> unknown = times();
  unknown[3] = std::numeric_limits<double>::quiet_NaN();
  std::vector<FrameLink> links = rolling_links(-0.25, 0.01);
  for (FrameLink& link : links) link.to = link.from + 2;  // half a frame, of two
  const auto finding = rolling_shutter(links, unknown);
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->unit, "frames");
  EXPECT_NEAR(finding->value, 0.5, 1e-9);
  EXPECT_NE(finding->text.find("before the first"), std::string::npos) << finding->text;
}

TEST(RollingShutter, NeedsFiveStandardErrorsOfTenReferences) {
  const double std_error = 0.1 / std::sqrt(test::link_count - 1.0);
  EXPECT_FALSE(rolling_shutter(rolling_links(4.9 * std_error, 0.1), times()).has_value());
  EXPECT_TRUE(rolling_shutter(rolling_links(5.1 * std_error, 0.1), times()).has_value());
  EXPECT_TRUE(rolling_shutter(rolling_links(0.06, 0.001), times()).has_value());
  EXPECT_FALSE(rolling_shutter(rolling_links(0.04, 0.001), times()).has_value()) << "a twentieth of a frame";
  EXPECT_FALSE(rolling_shutter(rolling_links(1.2, 0.01), times()).has_value()) << "longer than a frame";
  EXPECT_FALSE(rolling_shutter({}, times()).has_value());
  std::vector<FrameLink> links = rolling_links(0.5, 0.1);
  for (FrameLink& link : links) link.from = link.to > test::link_count / 2 ? test::link_count / 2 : 0;
  EXPECT_FALSE(rolling_shutter(links, times()).has_value()) << "links of two references";
}

}  // namespace
}  // namespace roadstereo::cli

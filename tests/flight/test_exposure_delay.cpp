// The delay between the exposures of both cameras, from links whose regression has a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "flight/exposure_delay.hpp"

namespace roadstereo::cli {
namespace {

constexpr double focal_px = 700, period_s = 0.1, rate_rad_per_s = 0.2;
constexpr int count = 40;

/// Links of a rig that turns left, left, right, right, …; the offsets are 0.2 px + f · delay · rate ± noise, in a
/// pattern that neither the constant nor the slope can take up.
std::vector<FrameLink> turning_links(double delay_s, double noise_px) {
  std::vector<FrameLink> links;
  for (int i = 0; i < count; ++i) {
    const double rate = i % 4 < 2 ? rate_rad_per_s : -rate_rad_per_s, angle = period_s * rate;
    FrameLink& link = links.emplace_back();
    link.from = i;
    link.to = i + 1;
    link.motion = {std::cos(angle), 0, std::sin(angle), 0.1, 0, 1, 0, 0, -std::sin(angle), 0, std::cos(angle), 0.5};
    link.measured_offset_px = 0.2 + focal_px * delay_s * rate + (i % 2 == 0 ? noise_px : -noise_px);
    link.measured_offset_sd_px = 0.05;
  }
  return links;
}

std::map<int, double> times(double period) {
  std::map<int, double> times;
  for (int i = 0; i <= count; ++i) times[i] = period * i;
  return times;
}

TEST(ExposureDelay, IsSlopeOfOffsetsInMilliseconds) {
  const auto finding = exposure_delay(turning_links(0.005, 0.1), times(period_s), focal_px);
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->id, "exposure-delay");
  EXPECT_EQ(finding->unit, "ms");
  EXPECT_NEAR(finding->value, 5, 1e-9);
  // Residuals ± e at rates ± r: standard error e / (r √(n − 2)), here in px per rad/s.
  EXPECT_NEAR(finding->limit, 5 * 1000 / focal_px * 0.1 / (rate_rad_per_s * std::sqrt(count - 2.0)), 1e-9);
  EXPECT_NE(finding->text.find("the right camera exposes 5.00 ± 0.12 ms later"), std::string::npos) << finding->text;
  EXPECT_FALSE(finding->spoils_depth);
}

TEST(ExposureDelay, IsInFramesWithoutTimes) {
  std::map<int, double> unknown = times(period_s);
  unknown[3] = std::numeric_limits<double>::quiet_NaN();
  const auto finding = exposure_delay(turning_links(-0.005, 0.1), unknown, focal_px);
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->unit, "frames");
  EXPECT_NEAR(finding->value, 0.05, 1e-9);
  EXPECT_NE(finding->text.find("earlier"), std::string::npos) << finding->text;
}

TEST(ExposureDelay, NeedsFiveStandardErrors) {
  // 0.5 ms is 4.3 standard errors of 0.116 ms, 0.6 ms is 5.2 of them.
  EXPECT_FALSE(exposure_delay(turning_links(0.0005, 0.1), times(period_s), focal_px).has_value());
  EXPECT_TRUE(exposure_delay(turning_links(0.0006, 0.1), times(period_s), focal_px).has_value());
  EXPECT_FALSE(exposure_delay({}, times(period_s), focal_px).has_value());
}

/// Links of a rig that drives straight but for turns of eight links, `every` links apart.
std::vector<FrameLink> links_with_turns(int every, double delay_s) {
  std::vector<FrameLink> links = turning_links(0, 0.02);
  for (int i = 0; i < count; ++i) {
    const double rate = i % every < 8 ? rate_rad_per_s : 0, angle = period_s * rate;
    FrameLink& link = links[static_cast<std::size_t>(i)];
    link.motion = {std::cos(angle), 0, std::sin(angle), 0.1, 0, 1, 0, 0, -std::sin(angle), 0, std::cos(angle), 0.5};
    link.measured_offset_px += focal_px * delay_s * rate;
  }
  return links;
}

// What else is different in the only turn of a recording would be taken for a delay.
TEST(ExposureDelay, NeedsTwoTurns) {
  EXPECT_FALSE(exposure_delay(links_with_turns(count, 0.005), times(period_s), focal_px).has_value());
  const auto finding = exposure_delay(links_with_turns(count / 2, 0.005), times(period_s), focal_px);
  ASSERT_TRUE(finding.has_value());
  EXPECT_NEAR(finding->value, 5, 0.5);
}

// Errors of groups of four links that are alike: ten scores of four times the size instead of forty, so that the
// standard error of the slope is √4 · √((10/8) / (40/38)) = 2.18 times what single links show.
TEST(ExposureDelay, ErrorsOfNeighboursAreOne) {
  constexpr int alike = 4;
  std::vector<FrameLink> links = turning_links(0.0008, 0);
  for (int i = 0; i < count; ++i) {
    const double rate = i / alike % 2 == 0 ? rate_rad_per_s : -rate_rad_per_s, angle = period_s * rate;
    FrameLink& link = links[static_cast<std::size_t>(i)];
    link.motion = {std::cos(angle), 0, std::sin(angle), 0.1, 0, 1, 0, 0, -std::sin(angle), 0, std::cos(angle), 0.5};
    link.measured_offset_px = 0.2 + focal_px * 0.0008 * rate + (i / (2 * alike) % 2 == 0 ? 0.1 : -0.1);
  }
  // 0.8 ms is 6.9 standard errors of 0.116 ms, those of independent links, and 3.2 of those of groups of four.
  EXPECT_FALSE(exposure_delay(links, times(period_s), focal_px).has_value());
}

TEST(ExposureDelay, LinksOfOneReferenceCountAsOne) {
  std::vector<FrameLink> links = turning_links(0.005, 0.1);
  for (FrameLink& link : links) link.from = link.to > count / 2 ? count / 2 : 0;
  EXPECT_FALSE(exposure_delay(links, times(period_s), focal_px).has_value());
}

}  // namespace
}  // namespace roadstereo::cli

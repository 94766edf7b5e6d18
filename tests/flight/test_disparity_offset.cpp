// A wrong offset of the disparities, from links whose mean and standard error have a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "flight/disparity_offset.hpp"
#include "tests/flight/alternating_links.hpp"

namespace roadstereo::cli {
namespace {

std::vector<FrameLink> links_with(double offset_px, double noise) {
  return test::alternating_links(&FrameLink::rig_offset_px, &FrameLink::rig_offset_sd_px, offset_px, noise);
}

TEST(DisparityOffset, IsMeanOfLinks) {
  const auto finding = disparity_offset(links_with(-5, 0.8));
  ASSERT_TRUE(finding.has_value());
  EXPECT_EQ(finding->id, "disparity-offset");
  EXPECT_NEAR(finding->value, 5, 1e-9);
  EXPECT_NEAR(finding->limit, 5 * 0.8 / std::sqrt(test::link_count - 1.0), 1e-9);
  EXPECT_NE(finding->text.find("are 5.00 ± 0.18 px too large"), std::string::npos) << finding->text;
  EXPECT_NE(disparity_offset(links_with(5, 0.8))->text.find("too small"), std::string::npos);
}

TEST(DisparityOffset, NeedsFiveStandardErrorsAndHalfAPixel) {
  EXPECT_FALSE(disparity_offset(links_with(0.49, 0)).has_value());
  EXPECT_TRUE(disparity_offset(links_with(0.51, 0)).has_value());
  EXPECT_FALSE(disparity_offset(links_with(0.9, 0.8)).has_value());
  EXPECT_FALSE(disparity_offset({}).has_value());
}

}  // namespace
}  // namespace roadstereo::cli

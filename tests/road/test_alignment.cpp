// Row alignment of a pair, against known vertical offsets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadstereo/alignment.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {
namespace {

struct GreyPair {
  GreyImage left, right;
};

GreyPair render(const char* name, double row_offset_px) {
  synth::Scene scene = synth::named_scene(name);
  scene.supersampling = 1;
  scene.degradation.row_offset_px = row_offset_px;
  const synth::SyntheticPair pair = synth::render(scene);
  GreyPair grey;
  to_grey(pair.left.view(), 0, grey.left);
  to_grey(pair.right.view(), 0, grey.right);
  return grey;
}

RowAlignment measure(const char* name, double row_offset_px) {
  const GreyPair pair = render(name, row_offset_px);
  return measure_row_alignment(pair.left, pair.right);
}

TEST(MeasureRows, RoadOffsetIsWithinTenthOfPixel) {
  for (const double offset : {0.0, 0.5, -1.3, 4.0}) {
    const RowAlignment rows = measure("uav", offset);
    ASSERT_TRUE(rows.known());
    EXPECT_NEAR(rows.median_px, offset, 0.1);
    EXPECT_LT(rows.sigma_px, 0.3);
  }
}

// Seen at a slant the road is sheared between the views, and a vertical offset must not be taken for that.
TEST(MeasureRows, StreetOffsetIsWithinTwentiethOfPixel) {
  const RowAlignment rows = measure("street", 0.5);
  ASSERT_TRUE(rows.known());
  EXPECT_NEAR(rows.median_px, 0.5, 0.05);
}

/// Six times as large, bilinear: soft, as video of 3840 columns is.
GreyImage enlarged(const GreyImage& small) {
  constexpr int factor = 6;
  GreyImage large(factor * small.width(), factor * small.height());
  for (int v = 0; v < large.height(); ++v) {
    const double y = std::clamp((v + 0.5) / factor - 0.5, 0.0, small.height() - 1.001);
    const int top = static_cast<int>(y);
    for (int u = 0; u < large.width(); ++u) {
      const double x = std::clamp((u + 0.5) / factor - 0.5, 0.0, small.width() - 1.001);
      const int left = static_cast<int>(x);
      const double above = std::lerp(small(left, top), small(left + 1, top), x - left);
      const double below = std::lerp(small(left, top + 1), small(left + 1, top + 1), x - left);
      large(u, v) = static_cast<std::int16_t>(std::lround(std::lerp(above, below, y - top)));
    }
  }
  return large;
}

TEST(MeasureRows, SoftLargePictureShowsAsManyPoints) {
  const auto [left, right] = render("uav", 0.5);
  const RowAlignment small = measure_row_alignment(left, right);
  const RowAlignment large = measure_row_alignment(enlarged(left), enlarged(right));
  EXPECT_GT(large.points, 0.9 * small.points);
  EXPECT_NEAR(large.median_px, 3.0, 0.3);
}

// The lower half is 3 rows off, as a reflection in a bonnet may be.
TEST(MeasureRows, MaskedPartTakesNoPart) {
  auto [left, right] = render("uav", 0);
  Image<std::uint8_t> mask(left.width(), left.height(), 0);
  for (int v = left.height() / 3; v < left.height(); ++v) {
    std::fill_n(mask.row(v), mask.width(), std::uint8_t{255});
    if (v + 3 < left.height()) std::copy_n(right.row(v + 3), right.width(), right.row(v));
  }
  EXPECT_NEAR(measure_row_alignment(left, right).median_px, -3, 0.1);
  const RowAlignment masked = measure_row_alignment(left, right, 1, mask);
  EXPECT_TRUE(masked.known());
  EXPECT_NEAR(masked.median_px, 0, 0.1);
  const std::vector<RowSample> samples = sample_row_alignment(left, right, 1, mask);
  EXPECT_GE(samples.size(), 20U);
  for (const RowSample& sample : samples) EXPECT_LT(sample.v, left.height() / 3);
}

TEST(MeasureRows, NoTextureGivesNoOffset) {
  const GreyImage flat(200, 120, 1000);
  EXPECT_FALSE(measure_row_alignment(flat, flat).known());
}

}  // namespace
}  // namespace roadstereo

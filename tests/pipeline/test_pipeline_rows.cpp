// Rows of the two views that are not aligned.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "roadstereo/warning.hpp"
#include "tests/pipeline/synthetic_truth.hpp"

namespace roadstereo {
namespace {

/// Stripes along the rows tell nothing of the rows.
TEST(Pipeline, SaysThatRowsAreUnknown) {
  std::vector<std::uint8_t> stripes(std::size_t{320} * 240);
  for (std::size_t k = 0; k < stripes.size(); ++k) stripes[k] = static_cast<std::uint8_t>(120 + (k % 320 * 37) % 90);
  const FrameView picture = FrameView::grey8(stripes.data() + 4, 300, 240, 320);
  const FrameView moved = FrameView::grey8(stripes.data(), 300, 240, 320);
  Pipeline pipeline(preset("default"));
  const FrameResult& result = pipeline.process(moved, picture);
  EXPECT_FALSE(result.rows.known());
  const bool is_said = std::any_of(result.warnings.begin(), result.warnings.end(),
                                   [](const std::string& warning) { return warning_code(warning) == "rows-unknown"; });
  EXPECT_TRUE(is_said);
}

TEST(Pipeline, WarnsAboutRowOffset) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_offset_px = 1.5;
  const synth::SyntheticPair pair = synth::render(s);
  Pipeline pipeline;
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_NEAR(result.rows.median_px, 1.5, 0.15);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.back().find("the rows of the pair are not aligned"), std::string::npos);
  EXPECT_EQ(warning_code(result.warnings.back()), "rows-disagree");
  EXPECT_EQ(warning_code("A sentence: with a colon"), "");
  EXPECT_EQ(warning_code("word"), "");
}

/// The default preset with rows corrected or not.
FrameResult process_rows(const synth::SyntheticPair& pair, bool correct) {
  PipelineOptions options = preset("default");
  options.correct_rows = correct;
  Pipeline pipeline(options, pair.calibration);
  FrameResult result;
  pipeline.process(pair.left.view(), pair.right.view(), result);
  return result;
}

TEST(Pipeline, RowCorrectionHalvesError) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_offset_px = 0.8;
  const synth::SyntheticPair pair = synth::render(s);
  const FrameResult corrected = process_rows(pair, true), raw = process_rows(pair, false);
  EXPECT_NEAR(corrected.shift.misalignment.rows_px, 0.8, 0.1);
  EXPECT_EQ(raw.shift.misalignment.rows_px, 0);
  EXPECT_LT(test::compare(corrected.disparity, pair).median, 0.5 * test::compare(raw.disparity, pair).median);
}

// Turned by 0.05° the rows are 0.28 px apart at either side of 640 columns, and disparities are 0.16 px off at the
// lower border of 360 rows.
TEST(Pipeline, TurnOfRightCameraIsUndone) {
  synth::Scene s = synth::named_scene("uav");
  s.supersampling = 1;
  s.degradation.row_rotation_deg = 0.05;
  const synth::SyntheticPair pair = synth::render(s);
  const FrameResult corrected = process_rows(pair, true), raw = process_rows(pair, false);
  EXPECT_NEAR(std::abs(corrected.shift.misalignment.turn_rad), 0.05 * std::numbers::pi / 180, 1e-4);
  EXPECT_NEAR(corrected.shift.misalignment.rows_px, 0, 0.05);
  EXPECT_LT(test::compare(corrected.disparity, pair).median, 0.3 * test::compare(raw.disparity, pair).median);
}

// The texture of a street runs towards the horizon, on either side another way: matched in wrong rows, the road rolls.
TEST(Pipeline, RoadModelIsThatOfAlignedRows) {
  synth::Scene s = synth::named_scene("street");
  s.degradation.row_offset_px = -0.6;
  const synth::SyntheticPair pair = synth::render(s);
  const auto error = [&](bool correct) {
    return std::abs(process_rows(pair, correct).road.model.disparity(320, 250) - pair.plane.disparity(320, 250));
  };
  EXPECT_LT(error(true), 0.5 * error(false));
}

}  // namespace
}  // namespace roadstereo

// What the tables of the experiments show where a value is missing, on scores known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "evaluate/baseline_comparison.hpp"
#include "evaluate/region_score.hpp"
#include "evaluate/score_columns.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::cli;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

DisparityScore score_of(std::size_t labelled, double density, double error) {
  DisparityScore score;
  score.labelled_pixels = labelled;
  score.density = density;
  score.rms_px = score.mean_px = score.sd_px = score.median_px = error;
  score.bad_share = score.bad_or_missing_share = {error, error};
  return score;
}

TEST(Cell, ShowsWhatIsUnknownAndWhatIsInfinite) {
  EXPECT_EQ(Cell(1.25, 1).text(), "1.2");
  EXPECT_EQ(Cell(nan, 1).text(), "–");
  EXPECT_EQ(Cell(infinite, 1).text(), "∞");
  EXPECT_TRUE(Cell(infinite, 1).json().is_null());
}

TEST(MeanScore, LeavesOutFramesWithoutTruth) {
  const DisparityScore mean = mean_score({score_of(10, 0.8, 2), score_of(0, 0, nan)});
  EXPECT_DOUBLE_EQ(mean.density, 0.8);
  EXPECT_DOUBLE_EQ(mean.rms_px, 2);
  EXPECT_TRUE(std::isnan(mean_score({score_of(0, 0, nan)}).density));
}

TEST(RegionScore, EmptyRegionsHaveNoShares) {
  const RegionScore nothing;
  EXPECT_TRUE(std::isnan(nothing.f()));
  EXPECT_TRUE(std::isnan(nothing.iou()));
  const RegionScore missed{0, 0, 5};
  EXPECT_EQ(missed.f(), 0);
  EXPECT_EQ(missed.precision(), 0);
  EXPECT_DOUBLE_EQ((RegionScore{3, 4, 6}.f()), 0.6);
}

TEST(BaselineComparison, WithoutValueIsNotBest) {
  std::vector<DisparityScore> ours(method_names().size(), score_of(10, 1, 1));
  ours[method_index("default")] = score_of(10, 1, 0.5);
  std::vector<DisparityScore> lost = ours;
  lost[method_index("default")] = score_of(10, 0, nan);
  const BaselineComparison comparison = compare_with_baselines("pixels", {ours, lost}, {ours, lost});
  EXPECT_EQ(comparison.table.rows[0][1].text(), "best");
  EXPECT_EQ(comparison.table.rows[1][1].text(), "–");
  EXPECT_NE(comparison.summary.find("best in 1 of 2 groups"), std::string::npos) << comparison.summary;
}

}  // namespace

// Options by name: presets, parsing, and the sentences for what is wrong.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/options.hpp"

namespace roadstereo {
namespace {

std::string refusal(const std::string& key, const std::string& value) {
  PipelineOptions options;
  try {
    set_option(options, key, value);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Presets, PaperHasConstantsOfPaper) {
  const PipelineOptions paper = preset("paper");
  EXPECT_EQ(paper.matcher.block_radius, 5);  // 120-connected
  EXPECT_EQ(paper.matcher.block_aspect, 1);
  EXPECT_EQ(paper.matcher.aggregation_radius, 5);
  EXPECT_EQ(paper.matcher.pixel_step, 1);
  EXPECT_FALSE(paper.matcher.adapt_support);
  EXPECT_EQ(paper.matcher.aggregation_aspect, 1);
  EXPECT_EQ(paper.matcher.aggregation_step, 1);
  EXPECT_EQ(paper.matcher.aggregation_shape, WindowShape::square);
  EXPECT_EQ(paper.matcher.sigma_space, 1.5);
  EXPECT_EQ(paper.matcher.sigma_colour, 5.5);
  EXPECT_EQ(paper.matcher.lr_max_diff_px, 1);
  EXPECT_EQ(paper.matcher.occlusion_sigma_px, 0);
  EXPECT_EQ(paper.matcher.ncc_noise_sigma, 0);
  EXPECT_TRUE(paper.matcher.match_both_views);
  EXPECT_EQ(paper.matcher.prior_weight, 0);
  EXPECT_EQ(paper.matcher.peak_fit, PeakFit::parabola);  // eq. (13)
  EXPECT_FALSE(paper.matcher.reject_range_boundary);
  EXPECT_EQ(paper.lucas_kanade.radius, 0);
  EXPECT_EQ(paper.off_road.max_sigma_px, 0);
  EXPECT_EQ(paper.refinement.radius, 0);
  EXPECT_EQ(paper.roll.initial_lambda, 10);
  EXPECT_NEAR(paper.roll.roll_threshold_rad, 3.14159265358979 / 1.8e6, 1e-18);
  EXPECT_EQ(paper.roll.solver, RollSolver::gradient_descent);
  EXPECT_FALSE(paper.road_model.with_roll);
  EXPECT_EQ(paper.perspective.shift, ShiftPrecision::whole_pixel);
  EXPECT_FALSE(paper.correct_rows);
}

TEST(Presets, AreValidAndUnknownIsRejected) {
  for (const std::string& name : preset_names()) EXPECT_NO_THROW(preset(name).validate());
  EXPECT_THROW(preset("fastest"), Error);
}

TEST(SetOption, ParsesNumbersWordsAndBooleans) {
  PipelineOptions options;
  set_option(options, "matcher.sigma_space", "2.5");
  set_option(options, "perspective.disparities", "33");
  set_option(options, "road_model.with_roll", "false");
  set_option(options, "roll.solver", "closed_form");
  set_option(options, "perspective.delta_p_px", "-1");
  EXPECT_EQ(options.matcher.sigma_space, 2.5);
  EXPECT_EQ(options.perspective.disparities, 33);
  EXPECT_FALSE(options.road_model.with_roll);
  EXPECT_EQ(options.roll.solver, RollSolver::closed_form);
}

TEST(SetOption, RefusedValueChangesNothing) {
  PipelineOptions options;
  for (const char* key : {"threads", "matcher.sigma_space"}) EXPECT_THROW(set_option(options, key, "4x"), Error) << key;
  EXPECT_EQ(options.threads, PipelineOptions{}.threads);
  EXPECT_EQ(options.matcher.sigma_space, PipelineOptions{}.matcher.sigma_space);
}

TEST(SetOption, SuggestsNearestKey) {
  EXPECT_EQ(refusal("matcher.sigma_spce", "2"),
            "there is no option called 'matcher.sigma_spce'; the nearest is 'matcher.sigma_space'");
  EXPECT_NE(refusal("sigma_colour", "2").find("matcher.sigma_colour"), std::string::npos);
}

TEST(SetOption, ErrorSaysExpectedValue) {
  EXPECT_EQ(refusal("perspective.disparities", "many"),
            "'many' is not a valid value of perspective.disparities; it takes a whole number");
  EXPECT_EQ(refusal("perspective.disparities", "3.5"),
            "'3.5' is not a valid value of perspective.disparities; it takes a whole number");
  EXPECT_EQ(refusal("matcher.sub_pixel", "maybe"),
            "'maybe' is not a valid value of matcher.sub_pixel; it takes true or false");
  EXPECT_EQ(refusal("perspective.shift", "half"),
            "'half' is not a valid value of perspective.shift; it takes whole_pixel or sub_pixel");
  EXPECT_NE(refusal("matcher.sigma_space", ""), "accepted");
}

TEST(PipelineOptions, WholePixelShiftsNeedNoLucasKanadeStep) {
  PipelineOptions options = preset("default");
  options.perspective.shift = ShiftPrecision::whole_pixel;
  EXPECT_THROW(options.validate(), Error);
  options.lucas_kanade.radius = 0;
  EXPECT_NO_THROW(options.validate());
}

/// What `validate` says after one option was set.
std::string what_validate_says(const std::string& key, const std::string& value) {
  PipelineOptions options;
  set_option(options, key, value);
  try {
    options.validate();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

// No number is a value of every option, and few options have values without end.
TEST(PipelineOptions, EveryNumberHasARange) {
  const std::set<std::string> without_lowest{"perspective.delta_p_px", "roll.delta_t_px"};
  const std::set<std::string> without_highest{"refinement.max_sigma_px", "roll.max_roll_stderr_rad",
                                              "roll.min_gradient_px"};
  std::size_t reals = 0, wholes = 0;
  for (const OptionText& option : list_options({})) {
    const bool is_real = option.kind == OptionKind::real;
    if (!is_real && option.kind != OptionKind::whole) continue;
    ++(is_real ? reals : wholes);
    std::vector<std::string> refused;
    if (is_real) refused.insert(refused.end(), {"nan", "-nan"});
    if (without_lowest.count(option.key) == 0) refused.emplace_back("-1000000000");
    if (without_highest.count(option.key) == 0) refused.emplace_back("1000000000");
    for (const std::string& value : refused) {
      EXPECT_NE(what_validate_says(option.key, value).find(option.key), std::string::npos)
          << option.key << " = " << value << ": " << what_validate_says(option.key, value);
    }
  }
  EXPECT_GE(reals, 45U);
  EXPECT_GE(wholes, 10U);
}

TEST(ListOptions, EveryOptionRoundTrips) {
  PipelineOptions options = preset("paper");
  options.matcher.sigma_space = 1.0 / 3;
  PipelineOptions copy;
  for (const OptionText& option : list_options(options)) {
    set_option(copy, option.key, option.value);
    EXPECT_FALSE(option.description.empty());
  }
  const auto written = list_options(options), read = list_options(copy);
  for (std::size_t i = 0; i < written.size(); ++i) EXPECT_EQ(written[i].value, read[i].value) << written[i].key;
  EXPECT_EQ(copy.matcher.sigma_space, 1.0 / 3);
}

}  // namespace
}  // namespace roadstereo

// Every engine of the registry against the double-precision reference, on the sizes and disparity counts that are
// awkward for vectors, and the properties that hold whatever the engine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include "roadstereo/error.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/pipeline.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

struct Case {
  const char* name;
  int width, height, disparities;
  MatcherOptions options;
  bool slanted_view;         ///< the target's first valid column differs from row to row
  bool with_ranges = false;  ///< tiles search parts of the disparities
  int prior_factor = 0;      ///< a prior of this factor; 0: none
  double prior_offset = 0;   ///< of the prior from the truth, pixels
  double prior_width = 0;    ///< of its intervals, pixels, at most; 0: none
};

MatcherOptions paper_options() {
  MatcherOptions options;
  options.pixel_step = 1;
  options.block_radius = 5;
  options.block_aspect = 1;
  options.aggregation_radius = 5;
  options.aggregation_step = 1;
  options.aggregation_shape = WindowShape::square;
  options.sigma_space = 1.5;
  options.sigma_colour = 5.5;
  options.ncc_noise_sigma = 0;
  options.peak_fit = PeakFit::parabola;
  options.match_both_views = true;
  options.reject_range_boundary = false;
  return options;
}

MatcherOptions plain_ncc() {
  MatcherOptions options;
  options.aggregation_radius = 0;
  options.block_radius = 2;
  options.block_aspect = 1;
  return options;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int d : {1, 7, 30, 33, 100}) {
    all.push_back({"odd_small", 33, 35, d, MatcherOptions{}, true});
    all.push_back({"paper_small", 129, 47, d, paper_options(), true});
  }
  all.push_back({"odd_large", 641, 359, 30, MatcherOptions{}, true});
  all.push_back({"plain_ncc", 97, 61, 33, plain_ncc(), false});
  MatcherOptions large_block;
  large_block.block_radius = 10;
  large_block.block_aspect = 1;
  large_block.aggregation_radius = 10;
  all.push_back({"large_windows", 90, 64, 20, large_block, true});
  all.push_back({"fast", 141, 61, 33, preset("fast").matcher, false});
  MatcherOptions low;  // where a road is foreshortened
  low.block_aspect = 0.25;
  all.push_back({"low_blocks", 141, 61, 33, low, true, false, 2, -1.5});
  MatcherOptions noisy;  // as adapt_support makes it
  noisy.block_radius = 6;
  all.push_back({"noisy", 141, 61, 33, noisy, true});
  MatcherOptions two_views;
  two_views.pixel_step = 1;
  two_views.match_both_views = true;
  all.push_back({"two_views", 150, 60, 35, two_views, true});
  MatcherOptions every_pixel;
  every_pixel.pixel_step = 1;
  all.push_back({"every_pixel", 161, 67, 33, every_pixel, true, false, 2, -1.5});
  MatcherOptions strict;  // what fails the left-right check is invalid
  strict.occlusion_sigma_px = 0;
  all.push_back({"strict_check", 150, 60, 35, strict, true});
  MatcherOptions loose = strict;
  loose.lr_max_diff_px = 3;
  all.push_back({"loose_check", 150, 60, 35, loose, true});
  MatcherOptions unchecked = strict;
  unchecked.left_right_check = false;
  all.push_back({"unchecked", 150, 60, 35, unchecked, true});
  MatcherOptions whole_pixels = strict;
  whole_pixels.sub_pixel = false;
  all.push_back({"whole_pixels", 150, 60, 35, whole_pixels, true});
  MatcherOptions bounded;  // the truth leaves three disparities, and the ranges
  bounded.reject_range_boundary = true;
  all.push_back({"bounded", 150, 60, 3, bounded, true});
  all.push_back({"bounded_ranges", 290, 131, 40, bounded, true, true});
  MatcherOptions sparse;
  sparse.aggregation_radius = 5;
  sparse.aggregation_step = 2;
  all.push_back({"sparse_window", 150, 60, 35, sparse, true});
  MatcherOptions large_ring;  // so large that the row is matched in several tiles of columns
  large_ring.block_radius = 2;
  large_ring.aggregation_radius = 10;
  all.push_back({"tiles", 270, 31, 33, large_ring, true});
  all.push_back({"ranges", 290, 131, 40, two_views, true, true});
  all.push_back({"prior_below", 131, 67, 33, MatcherOptions{}, true, false, 2, -2.5});
  all.push_back({"prior_above", 131, 67, 33, MatcherOptions{}, true, false, 3, 3.5});
  all.push_back({"prior_of_intervals", 131, 67, 33, MatcherOptions{}, true, false, 2, -2.5, 4});
  all.push_back({"prior_with_ranges", 200, 101, 40, MatcherOptions{}, true, true, 3, 1.5});
  MatcherOptions steep;  // so steep that the winner need not be a minimum of the costs
  steep.prior_weight = 0.5;
  steep.aggregation_radius = 0;
  all.push_back({"steep_prior", 131, 67, 33, steep, false, false, 2, -1.25});
  MatcherOptions unused;
  unused.prior_weight = 0;
  all.push_back({"unused_prior", 131, 67, 20, unused, true, false, 2, 1});
  return all;
}

/// A different range for every tile, some of them without the right disparity.
SearchRanges uneven_ranges(int width, int height, int disparities) {
  SearchRanges ranges;
  ranges.assign(width, height, disparities);
  int n = 0;
  for (auto* grid : {&ranges.reference, &ranges.target}) {
    for (int row = 0; row < grid->height(); ++row) {
      for (int column = 0; column < grid->width(); ++column, ++n) {
        const int first = n * 7 % (disparities / 2);
        (*grid)(column, row) = {static_cast<std::int16_t>(first),
                                static_cast<std::int16_t>(std::min(disparities, first + 1 + n * 5 % disparities))};
      }
    }
  }
  return ranges;
}

/// The disparity that the pairs of the cases are painted with.
double true_disparity(const Case& setting, double u, double v) {
  return std::min(setting.disparities, setting.width / 2) * 0.4 + 2.0 * std::sin(0.05 * u) * std::cos(0.07 * v);
}

/// The truth, off by the case's offset, with a hole; some of it below 0 or beyond the last disparity.
DisparityPrior prior_of(const Case& setting) {
  DisparityPrior prior;
  prior.factor = std::max(1, setting.prior_factor);
  prior.disparity.resize(setting.width / prior.factor, setting.height / prior.factor);
  for (int y = 0; y < prior.disparity.height(); ++y) {
    for (int x = 0; x < prior.disparity.width(); ++x) {
      const double truth = true_disparity(setting, x * prior.factor, y * prior.factor);
      const double wide = y % 16 == 7 ? 10 * setting.prior_offset : setting.prior_offset;
      const bool hole = x % 16 < 5 && y % 8 < 3;
      prior.disparity(x, y) =
          hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(truth + wide + 0.3 * std::sin(0.7 * x));
    }
  }
  if (setting.prior_width == 0) return prior;
  prior.low = prior.high = prior.disparity;
  for (int y = 0; y < prior.disparity.height(); ++y) {
    for (int x = 0; x < prior.disparity.width(); ++x) {
      prior.low(x, y) -= static_cast<float>(setting.prior_width * (x % 3) / 4);
      prior.high(x, y) += static_cast<float>(setting.prior_width * (y % 3) / 4);
    }
  }
  return prior;
}

/// Within 1 %, or both infinite.
bool same_variance(double expected, double actual) {
  constexpr double float_costs = 1e-7;  // of costs near 0
  return expected == actual || std::abs(expected - actual) <= 0.01 * expected + float_costs;
}

/// Skips a test of the engine `cuda` where no GPU can run it; it fails where ROADSTEREO_NEEDS_GPU is set.
void require_engine(const std::string& name) {
  if (name != "cuda") return;
  for (const UnavailableEngine& absent : unavailable_engines()) {
    if (absent.name != name) continue;
    if (std::getenv("ROADSTEREO_NEEDS_GPU") != nullptr) FAIL() << absent.reason;
    GTEST_SKIP() << absent.reason;
  }
}

class EngineAgreement : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  void SetUp() override { require_engine(std::get<0>(GetParam())); }
};

TEST_P(EngineAgreement, WinnerAndSubPixelMatchReference) {
  const Case setting = cases()[static_cast<std::size_t>(std::get<1>(GetParam()))];
  const auto pair = test::textured_pair(setting.width, setting.height,
                                        [&](double u, double v) { return true_disparity(setting, u, v); });
  std::vector<int> first(static_cast<std::size_t>(setting.height), 0);
  if (setting.slanted_view) {
    for (int v = 0; v < setting.height; ++v) first[static_cast<std::size_t>(v)] = v / 4 % (setting.width / 3);
  }
  const SearchRanges ranges = uneven_ranges(setting.width, setting.height, std::max(2, setting.disparities));
  const DisparityPrior prior = prior_of(setting);
  const MatchInput input{pair.reference,
                         pair.target,
                         first.data(),
                         setting.disparities,
                         setting.with_ranges ? ranges.views() : SearchRangeViews{},
                         setting.prior_factor > 0 ? prior.view() : DisparityPriorView{}};
  MatchMaps expected, actual;
  make_engine("reference", 0)->match(input, setting.options, expected);
  make_engine(std::get<0>(GetParam()), 2)->match(input, setting.options, actual);

  std::size_t candidates = 0, same = 0, target_same = 0, both = 0, variances_differ = 0, validities_differ = 0;
  double worst = 0;
  const int step = setting.options.pixel_step;
  ASSERT_EQ(expected.winner.width(), (setting.width + step - 1) / step);
  ASSERT_EQ(expected.winner.height(), (setting.height + step - 1) / step);
  ASSERT_EQ(actual.disparity.width(), expected.winner.width());
  ASSERT_EQ(actual.disparity.height(), expected.winner.height());
  ASSERT_EQ(actual.target_winner.width(), setting.width);
  for (int v = 0; v < expected.winner.height(); ++v) {
    for (int u = 0; u < setting.width; ++u) target_same += expected.target_winner(u, v) == actual.target_winner(u, v);
    for (int u = 0; u < expected.winner.width(); ++u) {
      ++candidates;
      same += expected.winner(u, v) == actual.winner(u, v);
      if (expected.winner(u, v) != actual.winner(u, v)) continue;
      const bool expected_none = std::isnan(expected.disparity(u, v)), actual_none = std::isnan(actual.disparity(u, v));
      validities_differ += expected_none != actual_none;
      if (expected_none || actual_none) continue;
      ++both;
      worst = std::max(worst, std::abs(static_cast<double>(expected.disparity(u, v)) - actual.disparity(u, v)));
      variances_differ += !same_variance(expected.variance(u, v), actual.variance(u, v));
    }
  }
  // A curvature near 0 has no relative precision in 32 bits.
  EXPECT_LE(static_cast<double>(variances_differ), 0.004 * static_cast<double>(both));
  EXPECT_GE(static_cast<double>(same), 0.999 * static_cast<double>(candidates));
  EXPECT_LE(static_cast<double>(validities_differ), 0.001 * static_cast<double>(candidates));
  EXPECT_GE(static_cast<double>(target_same), 0.999 * static_cast<double>(expected.target_winner.pixels()));
  EXPECT_LE(worst, 0.01);
  if (setting.disparities >= 7 && setting.width > 100 && !setting.with_ranges) {
    EXPECT_GT(both, candidates / 4);
  }
}

/// Fast engines of this build, whether this machine has a GPU or not: to ask the registry would make a CUDA context in
/// every process of this program.
std::vector<std::string> engine_names() {
  std::vector<std::string> names{"cpu"};
#if defined(ROADSTEREO_WITH_CUDA)
  names.emplace_back("cuda");
#endif
  return names;
}

/// Indices of the cases on which the reference, or a sanitizer, takes long; or of all others.
std::vector<int> cases_that_are(bool slow) {
  const std::vector<Case> all = cases();
  std::vector<int> indices;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string name = all[i].name;
    if ((all[i].disparities == 100 || name == "odd_large" || name == "large_windows") == slow) {
      indices.push_back(static_cast<int>(i));
    }
  }
  return indices;
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<std::string, int>>& test) {
  const Case c = cases()[static_cast<std::size_t>(std::get<1>(test.param))];
  return std::get<0>(test.param) + "_" + c.name + "_" + std::to_string(c.disparities);
}

INSTANTIATE_TEST_SUITE_P(Registry, EngineAgreement,
                         testing::Combine(testing::ValuesIn(engine_names()), testing::ValuesIn(cases_that_are(false))),
                         name_of_case);
INSTANTIATE_TEST_SUITE_P(Slow, EngineAgreement,
                         testing::Combine(testing::ValuesIn(engine_names()), testing::ValuesIn(cases_that_are(true))),
                         name_of_case);

class EveryEngine : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { require_engine(GetParam()); }
};

std::vector<std::string> all_engine_names() {
  std::vector<std::string> names = engine_names();
  names.emplace_back("reference");
  return names;
}

TEST_P(EveryEngine, FindsConstantDisparityUpToEdges) {
  constexpr int width = 120, height = 60, d = 9;
  const auto pair = test::textured_pair(width, height, [](double, double) { return d; });
  const MatcherOptions options;
  const int reach = options.block_radius + options.aggregation_radius;
  MatchMaps maps;
  make_engine(GetParam(), 2)->match({pair.reference, pair.target, nullptr, 20}, options, maps);
  const int step = options.pixel_step;
  for (int v = 0; v < height; v += step) {
    // At the first column of the common view the winner is the last candidate: no minimum.
    // Near the border the windows are clipped, blocks even differently at d − 1 and d + 1: the parabola leans further.
    for (int u = 0; u < width; u += step) {
      const float found = maps.disparity(u / step, v / step);
      const bool clipped = std::min({u - d - 1, width - 1 - u, v, height - 1 - v}) < reach;
      if (u > d) {
        ASSERT_NEAR(found, d, clipped ? 0.35 : 0.25) << u << "," << v;
      } else if (u < d - 1) {
        ASSERT_FALSE(std::abs(found - d) < 0.5) << u << "," << v;
      }
    }
  }
}

TEST_P(EveryEngine, NoTextureGivesNoDisparity) {
  GreyImage flat(64, 48, 1600);
  MatcherOptions options;
  options.reject_range_boundary = true;
  MatchMaps maps;
  make_engine(GetParam(), 1)->match({flat, flat, nullptr, 16}, options, maps);
  ASSERT_EQ(maps.winner.pixels(), 64U / 2 * 48 / 2);
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 32; ++u) {
      EXPECT_EQ(maps.winner(u, v), 0);  // all costs are equal: the smallest disparity wins
      EXPECT_TRUE(std::isnan(maps.disparity(u, v)));
    }
  }
}

TEST_P(EveryEngine, IsIndependentOfThreads) {
  const auto pair = test::textured_pair(150, 130, [](double, double v) { return 6 + 0.03 * v; });
  MatchMaps one, three;
  make_engine(GetParam(), 1)->match({pair.reference, pair.target, nullptr, 16}, MatcherOptions{}, one);
  make_engine(GetParam(), 3)->match({pair.reference, pair.target, nullptr, 16}, MatcherOptions{}, three);
  EXPECT_EQ(one.winner, three.winner);
  EXPECT_EQ(one.target_winner, three.target_winner);
  for (int v = 0; v < one.disparity.height(); ++v) {
    for (int u = 0; u < one.disparity.width(); ++u) {
      const float a = one.disparity(u, v), b = three.disparity(u, v);
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST_P(EveryEngine, ReadsStridedImagesAfterOtherFrame) {
  const auto pair = test::textured_pair(80, 50, [](double, double) { return 5; });
  Image<std::int16_t> wide_ref(103, 50, 4000), wide_tar(103, 50, 17);
  for (int v = 0; v < 50; ++v) {
    std::copy_n(pair.reference.row(v), 80, wide_ref.row(v));
    std::copy_n(pair.target.row(v), 80, wide_tar.row(v));
  }
  const auto engine = make_engine(GetParam(), 1);
  MatchMaps packed, strided;
  engine->match({pair.reference, pair.target, nullptr, 12}, MatcherOptions{}, packed);
  const auto other = test::textured_pair(
      100, 70, [](double, double) { return 3; }, 9);
  engine->match({other.reference, other.target, nullptr, 40}, paper_options(), strided);
  engine->match({{wide_ref.row(0), 80, 50, 103}, {wide_tar.row(0), 80, 50, 103}, nullptr, 12}, MatcherOptions{},
                strided);
  EXPECT_EQ(packed.winner, strided.winner);
}

TEST_P(EveryEngine, RangesThatHoldDisparityHaveNoEffect) {
  constexpr int width = 200, height = 110;  // two tiles across, two down
  const auto pair = test::textured_pair(width, height, [](double, double) { return 12; });
  SearchRanges ranges;
  ranges.assign(width, height, 32);
  for (int column = 0; column < 2; ++column) {
    for (int row = 0; row < 2; ++row) ranges.reference(column, row) = ranges.target(column, row) = {9, 16};
  }
  MatchMaps all, narrow;
  const auto engine = make_engine(GetParam(), 2);
  engine->match({pair.reference, pair.target, nullptr, 32}, MatcherOptions{}, all);
  engine->match({pair.reference, pair.target, nullptr, 32, ranges.views(), {}}, MatcherOptions{}, narrow);
  for (int v = 0; v < all.disparity.height(); ++v) {
    for (int u = 20; u < all.disparity.width(); ++u) ASSERT_NEAR(all.disparity(u, v), narrow.disparity(u, v), 1e-5);
  }
}

TEST_P(EveryEngine, PriorDecidesWithoutTexture) {
  constexpr int reach = 4;  // pixels; further away one disparity is as good as the other
  MatcherOptions options;
  options.prior_truncation_px = reach;
  const GreyImage flat(64, 48, 1600);
  DisparityPrior prior{Image<float>(32, 24, 7.0F), 2};
  for (int y = 12; y < 24; ++y) std::fill_n(prior.disparity.row(y), 32, std::numeric_limits<float>::quiet_NaN());
  MatchMaps maps;
  make_engine(GetParam(), 2)->match({flat, flat, nullptr, 16, {}, prior.view()}, options, maps);
  const int step = options.pixel_step;
  for (int v = 0; v < 48; v += step) {
    for (int u = 0; u < 64; u += step) {
      ASSERT_EQ(maps.winner(u / step, v / step), v < 24 && u > 7 - reach ? std::min(u, 7) : 0) << u << ", " << v;
      ASSERT_TRUE(std::isinf(maps.variance(u / step, v / step))) << u << ", " << v;
    }
  }
}

/// Of disparities that cost the same, those of the interval cost least, and the smallest of them wins.
TEST_P(EveryEngine, DisparitiesOfIntervalCostNothing) {
  const GreyImage flat(64, 48, 1600);
  DisparityPrior prior{Image<float>(32, 24, 7.0F), 2, Image<float>(32, 24, 4.5F), Image<float>(32, 24, 9.0F)};
  MatchMaps maps;
  make_engine(GetParam(), 2)->match({flat, flat, nullptr, 16, {}, prior.view()}, MatcherOptions{}, maps);
  for (int y = 0; y < maps.winner.height(); ++y) {
    for (int x = 8; x < maps.winner.width(); ++x) ASSERT_EQ(maps.winner(x, y), 5) << x << ", " << y;
  }
  prior.high = Image<float>(31, 24, 9.0F);
  EXPECT_THROW(make_engine(GetParam(), 1)->match({flat, flat, nullptr, 16, {}, prior.view()}, MatcherOptions{}, maps),
               Error);
  prior.high = {};
  EXPECT_THROW(make_engine(GetParam(), 1)->match({flat, flat, nullptr, 16, {}, prior.view()}, MatcherOptions{}, maps),
               Error);
}

TEST_P(EveryEngine, RejectsBadInput) {
  const GreyImage a(64, 48), b(64, 47);
  MatchMaps maps;
  const auto engine = make_engine(GetParam(), 1);
  EXPECT_THROW(engine->match({a, b, nullptr, 16}, MatcherOptions{}, maps), Error);
  EXPECT_THROW(engine->match({a, a, nullptr, 0}, MatcherOptions{}, maps), Error);
  EXPECT_THROW(engine->match({a, a, nullptr, 1025}, MatcherOptions{}, maps), Error);
  MatcherOptions options;
  options.block_radius = 0;
  EXPECT_THROW(engine->match({a, a, nullptr, 16}, options, maps), Error);
  SearchRanges ranges;
  ranges.assign(300, 48, 16);
  EXPECT_THROW(engine->match({a, a, nullptr, 16, ranges.views(), {}}, MatcherOptions{}, maps), Error);
  const DisparityPrior prior{Image<float>(32, 24, 3.0F), 0};
  EXPECT_THROW(engine->match({a, a, nullptr, 16, {}, prior.view()}, MatcherOptions{}, maps), Error);
  ranges.assign(64, 48, 17);
  EXPECT_THROW(engine->match({a, a, nullptr, 16, ranges.views(), {}}, MatcherOptions{}, maps), Error);
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryEngine, testing::ValuesIn(all_engine_names()),
                         [](const auto& test) { return test.param; });

TEST(EngineRegistry, UnknownNameListsEngines) {
  std::string known = "auto";
  for (const EngineInfo& info : engines()) known += ", " + info.name;
  try {
    make_engine("gpu", 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "there is no engine called 'gpu'; this build has: " + known);
  }
  for (const UnavailableEngine& absent : unavailable_engines()) {
    try {
      make_engine(absent.name, 1);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()),
                "the engine " + absent.name + " cannot be used: " + absent.reason + "; there are: " + known);
    }
  }
  EXPECT_EQ(resolve_engine_name("auto"), engines().front().name);
  EXPECT_EQ(resolve_engine_name("cpu"), "cpu");
}

}  // namespace
}  // namespace roadstereo

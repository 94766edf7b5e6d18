// Every instruction set that this machine has, against the double-precision reference, by the rule of test_engines.

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "roadstereo/matcher.hpp"
#include "roadstereo/pipeline.hpp"
#include "tests/core/every_target.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

using CpuEngineTarget = test::EveryTarget;

struct Setting {
  const char* preset;
  int width, height, disparities;
};
constexpr Setting settings[] = {{"default", 161, 67, 37}, {"fast", 131, 50, 16}, {"paper", 97, 51, 33}};

TEST_P(CpuEngineTarget, MatchesReference) {
  for (const Setting& setting : settings) {
    SCOPED_TRACE(setting.preset);
    const MatcherOptions options = preset(setting.preset).matcher;
    const auto pair = test::textured_pair(setting.width, setting.height, [&](double u, double v) {
      return 0.4 * setting.disparities + 2 * std::sin(0.05 * u) * std::cos(0.07 * v);
    });
    std::vector<int> first(static_cast<std::size_t>(setting.height));
    for (std::size_t v = 0; v < first.size(); ++v) first[v] = static_cast<int>(v / 5);
    const MatchInput input{pair.reference, pair.target, first.data(), setting.disparities};
    MatchMaps expected, actual;
    make_engine("reference", 0)->match(input, options, expected);
    make_engine("cpu", 2)->match(input, options, actual);
    std::size_t same = 0, target_same = 0, both = 0, validities_differ = 0;
    double worst = 0;
    for (int v = 0; v < expected.winner.height(); ++v) {
      for (int u = 0; u < setting.width; ++u) target_same += expected.target_winner(u, v) == actual.target_winner(u, v);
      for (int u = 0; u < expected.winner.width(); ++u) {
        same += expected.winner(u, v) == actual.winner(u, v);
        if (expected.winner(u, v) != actual.winner(u, v)) continue;
        const bool expected_none = std::isnan(expected.disparity(u, v));
        const bool actual_none = std::isnan(actual.disparity(u, v));
        validities_differ += expected_none != actual_none;
        if (expected_none || actual_none) continue;
        ++both;
        worst = std::max(worst, std::abs(double{expected.disparity(u, v)} - actual.disparity(u, v)));
      }
    }
    const auto pixels = static_cast<double>(expected.winner.pixels());
    EXPECT_GE(static_cast<double>(same), 0.999 * pixels);
    EXPECT_GE(static_cast<double>(target_same), 0.999 * static_cast<double>(expected.target_winner.pixels()));
    EXPECT_LE(static_cast<double>(validities_differ), 0.001 * pixels);
    EXPECT_GT(static_cast<double>(both), 0.5 * pixels);
    EXPECT_LE(worst, 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, CpuEngineTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo

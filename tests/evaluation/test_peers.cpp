// The presets beside OpenCV's matchers on synthetic roads with exact truth: the fast preset must not buy its speed with
// the quality of the road.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "evaluation/peer_matchers.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {
namespace {

struct Score {
  double median = 0;    ///< pixels
  double bad_half = 0;  ///< share of the pixels that both cameras see, wrong by more than 0.5 px or missing
  double bad_one = 0;   ///< the same for 1 px
};

/// Errors on the road: where the truth lies within 3 px of the plane.
Score score(const Image<float>& disparity, const synth::SyntheticPair& pair) {
  constexpr double sigma_road_px = 3;
  std::vector<double> errors;
  std::size_t seen = 0, bad_half = 0, bad_one = 0;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double truth = pair.disparity(u, v);
      if (!pair.visible(u, v) || !(std::abs(truth - pair.plane.disparity(u, v)) < sigma_road_px)) continue;
      ++seen;
      const double error = std::abs(disparity(u, v) - truth);
      bad_half += !(error <= 0.5);
      bad_one += !(error <= 1);
      if (!std::isnan(error)) errors.push_back(error);
    }
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  const auto all = static_cast<double>(seen);
  return {errors[errors.size() / 2], static_cast<double>(bad_half) / all, static_cast<double>(bad_one) / all};
}

/// What a user of OpenCV gets from the rectified pair; no disparity of the scene is out of its range.
Score score_peer(const std::string& name, const synth::SyntheticPair& pair) {
  GreyImage left, right;
  to_grey(pair.left.view(), 0, left);
  to_grey(pair.right.view(), 0, right);
  double largest = 0;
  for (int v = 0; v < left.height(); ++v) {
    for (int u = 0; u < left.width(); ++u) largest = std::fmax(largest, pair.disparity(u, v));
  }
  io::PeerMatcher matcher(name, static_cast<int>(largest) + 8);
  matcher.set_pair(left, right);
  matcher.match();
  return score(matcher.disparity(), pair);
}

void record(const std::string& name, const Score& s) {
  testing::Test::RecordProperty(name + "_median_px", std::to_string(s.median));
  testing::Test::RecordProperty(name + "_bad_half", std::to_string(s.bad_half));
  testing::Test::RecordProperty(name + "_bad_one", std::to_string(s.bad_one));
}

TEST(SlowPeers, FastPresetIsNoWorseThanSgbmOnRoads) {
  for (const char* name : {"demo", "uav", "street", "nadir", "close", "low_texture", "noise", "blur", "overexposed"}) {
    synth::Scene scene = synth::named_scene(name);
    scene.supersampling = 1;
    const synth::SyntheticPair pair = synth::render(scene);
    Pipeline pipeline(preset("fast"), pair.calibration);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    const Score own = score(result.disparity, pair);
    const Score peer = score_peer("SGBM", pair);
    record(std::string(name) + "_fast", own);
    record(std::string(name) + "_sgbm", peer);
    EXPECT_LE(own.median, peer.median) << name;
    EXPECT_LE(own.bad_half, peer.bad_half) << name;
    EXPECT_LE(own.bad_one, peer.bad_one) << name;
  }
}

TEST(Peers, RejectsUnknownName) {
  EXPECT_EQ(io::peer_names().size(), 4U);
  EXPECT_THROW(io::PeerMatcher("ELAS", 32), Error);
}

}  // namespace
}  // namespace roadstereo

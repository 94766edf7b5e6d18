#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "graph/track_alignment.hpp"

namespace roadstereo {
namespace {

constexpr double frame_s = 0.1;

/// Where the antenna is on a bent way, at 8 m/s.
Eigen::Vector3d on_way(double time_s) {
  return {8 * time_s, 30 * std::sin(0.05 * time_s) + 10 * std::sin(0.31 * time_s), 100 + std::sin(0.1 * time_s)};
}

/// World of a piece to axes of the Earth: another turn and shift for each.
GraphPose truth_of(std::size_t piece) {
  const double angle = 0.7 * static_cast<double>(piece);
  return {{3.0 * static_cast<double>(piece), -20, 5},
          Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))};
}

std::vector<TimedPosition> pieces_of(std::size_t frames, std::size_t length) {
  std::vector<TimedPosition> timed;
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = frame_s * static_cast<double>(i);
    const GraphPose to_earth = truth_of(i / length);
    timed.push_back({i / length, time_s, to_earth.rotation.inverse() * (on_way(time_s) - to_earth.position)});
  }
  return timed;
}

std::map<std::size_t, std::size_t> counts_of(const std::vector<TimedPosition>& frames) {
  std::map<std::size_t, std::size_t> counts;
  for (const TimedPosition& frame : frames) ++counts[frame.piece];
  return counts;
}

TEST(FramesToAlign, AreAllOfShortRecording) {
  std::vector<TimedPosition> frames = pieces_of(500, 7);
  EXPECT_EQ(frames_to_align(frames).size(), 500U);
  frames[3].time_s = NAN;
  EXPECT_EQ(frames_to_align(frames).size(), 499U);
}

TEST(FramesToAlign, AreEvenInLongPiece) {
  const std::vector<TimedPosition> taken = frames_to_align(pieces_of(72'000, 72'000));
  ASSERT_EQ(taken.size(), 500U);
  for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_NEAR(taken[i].time_s, 14.4 * static_cast<double>(i), 1e-6);
}

TEST(FramesToAlign, AreTwentyOfShortPieces) {
  const auto counts = counts_of(frames_to_align(pieces_of(72'000, 150)));
  EXPECT_EQ(counts.size(), 480U);
  for (const auto& [piece, count] : counts) {
    EXPECT_GE(count, 20U) << piece;
    EXPECT_LE(count, 30U) << piece;
  }
}

// Every eighth frame is one of each piece, which tells no direction.
TEST(AlignToTrack, PlacesShortPiecesOfLongRecording) {
  constexpr std::size_t frames = 4000, length = 8;
  constexpr double ahead_s = 1.5;
  std::vector<PositionFix> fixes;
  for (int i = -20; i < 420; ++i) {
    const Eigen::Vector3d at = on_way(i);
    fixes.push_back({i + ahead_s, {at.x(), at.y(), at.z()}, 0.1, 0.2});
  }
  PoseGraphOptions options;
  options.lever_arm_sd_m = 0.1;
  options.max_time_offset_s = 3;
  const std::vector<std::optional<Eigen::Vector3d>> up(frames / length, Eigen::Vector3d::UnitZ());
  const std::vector<TimedPosition> timed = pieces_of(frames, length);
  const TrackAlignment alignment =
      align_to_track(frames_to_align(timed), up, FixCurve(fixes, options.max_fix_gap_s), options);
  ASSERT_TRUE(alignment.unused.empty()) << alignment.unused;
  EXPECT_NEAR(alignment.time_offset_s, ahead_s, 0.02);
  ASSERT_EQ(alignment.pieces.size(), frames / length);
  for (const TimedPosition& frame : timed) {
    const std::optional<GraphPose>& to_earth = alignment.pieces[frame.piece];
    ASSERT_TRUE(to_earth) << frame.piece;
    const Eigen::Vector3d at = to_earth->rotation * frame.position + to_earth->position;
    EXPECT_LT((at - on_way(frame.time_s)).norm(), 0.2) << frame.time_s;
  }
}

}  // namespace
}  // namespace roadstereo

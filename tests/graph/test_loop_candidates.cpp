#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/loop_candidates.hpp"

namespace roadstereo {
namespace {

/// A walk of cameras that do not turn. Their errors are shifts, so that those of the links add up and nothing else.
struct Walk {
  std::vector<KeyframeView> views;
  Trajectory odometry, best;

  FramePose pose(std::size_t i, double x, double z, double variance, int piece) const {
    FramePose result;
    result.frame = static_cast<int>(3 * i);
    result.camera_to_world = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, z};
    for (std::size_t k = 0; k < 3; ++k) result.covariance[7 * k] = variance;
    result.piece = piece;
    return result;
  }
};

Walk random_walk(std::size_t count, bool with_track, int pieces) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Walk walk;
  double heading = 0, x = 0, z = 0, drift = 0;
  for (std::size_t i = 0; i < count; ++i) {
    heading += 0.05 + 0.05 * normal(random);
    const double step_m = i % 100 < 10 ? 0 : 0.8;
    x += step_m * std::sin(heading);
    z += step_m * std::cos(heading);
    drift += 1e-4;
    const int piece = static_cast<int>(i / 400) % pieces;
    walk.odometry.frames.push_back(walk.pose(i, x, z, drift, piece));
    walk.best.frames.push_back(walk.pose(i, x, z, with_track ? 1e-3 : drift, piece));
    walk.views.push_back({static_cast<int>(3 * i), {0, 0, 3}, 1 + 0.05 * normal(random)});
  }
  return walk;
}

/// Brute force: whether two keyframes may show one place.
bool are_near(const Walk& walk, std::size_t i, std::size_t current) {
  const FramePose &a = walk.best.frames[i], &b = walk.best.frames[current];
  const double reach_m = walk.views[i].radius_m + walk.views[current].radius_m;
  const double of_links = walk.odometry.frames[current].covariance[0] - walk.odometry.frames[i].covariance[0];
  const double of_poses = a.covariance[0] + b.covariance[0];
  const bool linked = walk.odometry.frames[i].piece == walk.odometry.frames[current].piece;
  const double deviation_m = std::sqrt(3 * (linked ? std::min(of_poses, of_links) : of_poses));
  const double distance_m =
      std::hypot(a.camera_to_world[3] - b.camera_to_world[3], a.camera_to_world[11] - b.camera_to_world[11]);
  return a.piece == b.piece && distance_m < 0.7 * reach_m + 3 * deviation_m;
}

/// Brute force: first and last keyframe of each of the last three visits, the latest first.
std::vector<std::array<std::size_t, 2>> visits_of(const Walk& walk, std::size_t current) {
  std::vector<std::array<std::size_t, 2>> visits;
  bool left = false, in_visit = false;
  for (std::size_t i = current; i-- > 0;) {
    const FramePose &a = walk.best.frames[i], &b = walk.best.frames[current];
    left = left || (a.piece == b.piece && std::hypot(a.camera_to_world[3] - b.camera_to_world[3],
                                                     a.camera_to_world[11] - b.camera_to_world[11]) >
                                              walk.views[i].radius_m + walk.views[current].radius_m);
    const bool near = left && are_near(walk, i, current);
    if (near && !in_visit) visits.push_back({i, i});
    if (near) visits.back()[0] = i;
    in_visit = near;
  }
  visits.resize(std::min<std::size_t>(visits.size(), 3));
  return visits;
}

void expect_as_brute_force(const Walk& walk) {
  const LoopPlaces places(walk.views, walk.odometry, walk.best);
  std::size_t all = 0;
  for (std::size_t current = 0; current < walk.views.size(); ++current) {
    const std::vector<std::array<std::size_t, 2>> expected = visits_of(walk, current);
    const std::vector<LoopCandidates> visits = places.visits(current);
    ASSERT_EQ(visits.size(), expected.size()) << current;
    for (std::size_t k = 0; k < visits.size(); ++k) {
      ASSERT_FALSE(visits[k].empty());
      for (const std::size_t i : visits[k]) {
        EXPECT_GE(i, expected[k][0]);
        EXPECT_LE(i, expected[k][1]);
      }
    }
    all += visits.size();
  }
  EXPECT_GT(all, walk.views.size() / 6);  // places are seen again
}

TEST(LoopPlaces, FindsVisitsOfBruteForce) {
  expect_as_brute_force(random_walk(1500, false, 1));
}

TEST(LoopPlaces, FindsVisitsOfBruteForceWithTrack) {
  expect_as_brute_force(random_walk(1500, true, 1));
}

TEST(LoopPlaces, FindsVisitsOfBruteForceWithinPieces) {
  expect_as_brute_force(random_walk(1500, false, 2));
}

}  // namespace
}  // namespace roadstereo

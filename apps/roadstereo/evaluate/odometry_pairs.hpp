#pragma once

#include <cstddef>
#include <functional>

#include "evaluate/odometry_trials.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Rectified pair with the true pose of its left camera.
struct PosedPair {
  Frame left;
  Frame right;
  Pose pose{};
  double white_level = 0;  ///< 0: unknown
};

/// Pairs one after the other.
struct PosedPairs {
  StereoCalibration calibration;
  std::size_t frames = 0;
  std::function<PosedPair()> next;
};

/// Those of a recording, or rendered. Throws Error when a recording does not have one pair a pose.
PosedPairs posed_pairs(const OdometryTrialOptions& options);

}  // namespace roadstereo::cli

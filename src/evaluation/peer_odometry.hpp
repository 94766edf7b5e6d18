#pragma once

#include <array>
#include <memory>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// What users of OpenCV put together in forty lines: corners, optical flow (Lucas-Kanade, checked backwards) and PnP
/// with RANSAC on the disparities of the earlier frame.
class OpticalFlowOdometry {
 public:
  explicit OpticalFlowOdometry(const StereoCalibration& calibration);
  ~OpticalFlowOdometry();

  /// Returns the motion from the camera of the last frame to that of this one, 3×4, metres; nothing for the first frame
  /// and where PnP fails.
  std::optional<std::array<double, 12>> add(const GreyImage& grey, const Image<float>& disparity);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::io

#pragma once

#include <array>
#include <memory>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// OpenCV's RgbdOdometry (module rgbd of opencv_contrib): dense alignment of grey levels by the depths of the earlier
/// frame. It starts from the last motion. Its limits are widened for a camera on a vehicle: it is made for rooms.
class RgbdOdometry {
 public:
  /// Whether this build has the module.
  static bool available();

  /// Throws Error in a build without the module.
  explicit RgbdOdometry(const StereoCalibration& calibration);
  ~RgbdOdometry();

  /// Returns the motion from the camera of the last frame to that of this one, 3×4, metres; nothing for the first frame
  /// and where it fails.
  std::optional<std::array<double, 12>> add(const GreyImage& grey, const Image<float>& disparity);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::io

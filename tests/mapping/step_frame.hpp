#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "roadstereo/road_map.hpp"

namespace roadstereo {

inline constexpr int width = 160, height = 120;

inline StereoCalibration rig() {
  StereoCalibration calibration;
  calibration.focal_px = 120;
  calibration.cx_px = 79.5;
  calibration.cy_px = 59.5;
  calibration.baseline_m = 0.2;
  calibration.width = width;
  calibration.height = height;
  return calibration;
}

/// Camera `up_m` above z = 0 that looks straight down; the upper border of the image is at +y.
inline RigidTransform looking_down(double x, double y, double up_m) {
  return {1, 0, 0, x, 0, -1, 0, y, 0, 0, -1, up_m};
}

/// Road with a round step of `depth_m` around a point.
struct Step {
  double x = 0, y = 0, radius_m = 0.2, depth_m = 0;
  double height(double at_x, double at_y) const { return std::hypot(at_x - x, at_y - y) < radius_m ? -depth_m : 0; }
};

/// Frame of a road with exact disparities, plus noise.
struct TestFrame {
  // Bilinear interpolation between pixels with independent noise takes 5/9 of the variance, on average.
  Image<float> disparity{width, height}, sigma{width, height, 0.1F * 2 / 3};
  std::vector<std::uint8_t> grey = std::vector<std::uint8_t>(width * height, 100);
  MapFrame frame;

  /// `step` has a height(x, y), metres.
  template <class Surface = Step>
  TestFrame(const RigidTransform& pose, const Surface& step, double noise_px, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1);
    const StereoCalibration calibration = rig();
    const double up = pose[11], fb = calibration.focal_px * calibration.baseline_m;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        double z = up;  // the wall of the step is not seen from above: fixed-point iteration along the ray
        for (int i = 0; i < 20; ++i) {
          z = up - step.height(pose[3] + (u - calibration.cx_px) / calibration.focal_px * z,
                               pose[7] - (v - calibration.cy_px) / calibration.focal_px * z);
        }
        disparity(u, v) = static_cast<float>(fb / z + noise_px * noise(random));
      }
    }
    frame.disparity = disparity;
    frame.sigma = sigma;
    frame.image = FrameView::grey8(grey.data(), width, height);
    frame.road = {fb / up, 0, 0};
    frame.calibration = calibration;
    frame.camera_to_map = pose;
  }
};

}  // namespace roadstereo

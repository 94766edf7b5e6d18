#pragma once

#include <algorithm>
#include <string>

#include "odometry/link_estimator.hpp"
#include "roadstereo/odometry.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::test {

/// A rendered left image with its exact disparities and pose.
struct KnownFrame {
  GreyImage grey;
  Image<float> disparity;
  Image<float> sigma;
  DisparityPlane plane;
  RigidMotion pose;  ///< camera to road

  OdometryFrame maps() const { return {grey, disparity, sigma, true, plane}; }
};

inline KnownFrame known_frame(const synth::Scene& scene) {
  const synth::SyntheticPair pair = synth::render(scene);
  KnownFrame frame;
  to_grey(pair.left.view(), 0, frame.grey);
  frame.disparity.resize(pair.disparity.width(), pair.disparity.height());
  std::transform(pair.disparity.row(0), pair.disparity.row(0) + pair.disparity.pixels(), frame.disparity.row(0),
                 [](double d) { return static_cast<float>(d); });
  frame.sigma.assign(frame.disparity.width(), frame.disparity.height(), 0.05F);
  frame.plane = pair.plane;
  frame.pose = motion_of(scene.rig.camera_to_road());
  return frame;
}

/// The scene with fewer pixels and one ray for each.
inline synth::Scene smaller_scene(const std::string& name, int divisor) {
  synth::Scene scene = synth::named_scene(name);
  scene.rig.width /= divisor;
  scene.rig.height /= divisor;
  scene.rig.focal_px /= divisor;
  scene.supersampling = 1;
  return scene;
}

}  // namespace roadstereo::test

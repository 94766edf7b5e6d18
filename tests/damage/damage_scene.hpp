#pragma once

#include <cmath>
#include <random>

#include "tests/damage/damage_from_truth.hpp"

namespace roadstereo {

/// A pothole and a bump on a cambered road below a pitched rig.
inline synth::Scene damaged_scene() {
  synth::Scene scene;
  scene.name = "damaged";
  scene.supersampling = 1;
  scene.rig.focal_px = 600;
  scene.rig.baseline_m = 0.2;
  scene.rig.camera_height_m = 1.5;
  scene.rig.pitch_deg = 65;
  scene.road.camber = 0.01;
  scene.road.blobs = {{-0.3, 0.75, 0.18, 0.06, 0.2, 0.3, 3}, {0.35, 0.65, 0.17, -0.04, 0.1, 0.3, 8}};
  return scene;
}

inline synth::Scene intact_scene() {
  synth::Scene scene = damaged_scene();
  scene.road.blobs.clear();
  return scene;
}

/// Gaussian noise on the valid pixels of a map.
inline Image<float> with_noise(const Image<float>& map, double sigma_px, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, static_cast<float>(sigma_px));
  Image<float> noisy = map;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) noisy(u, v) += noise(random);
  }
  return noisy;
}

/// The transformed map of a disparity map whose road is `plane`.
inline Image<float> transformed_by(const DisparityPlane& plane, const Image<float>& disparity) {
  Image<float> transformed(disparity.width(), disparity.height());
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      transformed(u, v) = static_cast<float>(disparity(u, v) - plane.disparity(u, v) + true_road_px);
    }
  }
  return transformed;
}

/// Maps of a rendered road as a matcher without a fault would deliver them, but for noise.
struct ExactMaps {
  synth::SyntheticPair pair;
  Image<float> disparity, transformed;

  explicit ExactMaps(const synth::Scene& scene, double noise_px = 0.02) : pair(synth::render(scene)) {
    disparity = with_noise(damage_from_truth(pair).disparity, noise_px);
    transformed = transformed_by(pair.plane, disparity);
  }

  void forget(int u, int v) { disparity(u, v) = transformed(u, v) = truth::nan_value; }

  DamageInput metric() const {
    DamageInput input;
    input.transformed = transformed;
    input.disparity = disparity;
    input.plane = pair.plane;
    input.calibration = pair.calibration;
    return input;
  }
  DamageInput pixels() const {
    DamageInput input;
    input.transformed = transformed;
    return input;
  }
};

/// The maps of the damaged scene, rendered once.
inline const ExactMaps& damaged() {
  static const ExactMaps maps(damaged_scene());
  return maps;
}

/// F of the pixels of one kind of damage against a label.
inline double f_score(const Image<std::uint16_t>& ids, int id, const Image<std::uint16_t>& labels, int label) {
  double both = 0, one = 0;
  for (int v = 0; v < ids.height(); ++v) {
    for (int u = 0; u < ids.width(); ++u) {
      const bool found = ids(u, v) == id, there = labels(u, v) == label;
      both += found && there ? 2 : 0;
      one += (found ? 1 : 0) + (there ? 1 : 0);
    }
  }
  return one == 0 ? 0 : both / one;
}

}  // namespace roadstereo

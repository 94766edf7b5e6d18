#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::synth {

/// A small rig without anything on the road.
inline Scene bare_scene(double pitch_deg, double roll_deg) {
  Scene scene;
  scene.rig.width = 128;
  scene.rig.height = 96;
  scene.rig.focal_px = 100;
  scene.rig.camera_height_m = 1.5;
  scene.rig.pitch_deg = pitch_deg;
  scene.rig.roll_deg = roll_deg;
  scene.road.lane_marking = false;
  scene.supersampling = 1;
  return scene;
}

/// The named scene at a quarter of its pixels.
inline Scene small_scene(const std::string& name) {
  Scene scene = named_scene(name);
  scene.rig.width /= 4;
  scene.rig.height /= 4;
  scene.rig.focal_px /= 4;
  scene.supersampling = 2;
  return scene;
}

inline double grey(const Frame& frame, int u, int v) {
  return frame.bytes[static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(u)];
}

inline double mean_grey(const Frame& frame) {
  double sum = 0;
  for (const std::uint8_t byte : frame.bytes) sum += byte;
  return sum / static_cast<double>(frame.bytes.size());
}

/// Value between the pixels of a row: cubic convolution over four pixels.
inline double cubic_sample(const Frame& frame, double u, int v) {
  const int left = static_cast<int>(std::floor(u));
  const double t = u - left;
  const double a = grey(frame, left - 1, v);
  const double b = grey(frame, left, v);
  const double c = grey(frame, left + 1, v);
  const double d = grey(frame, left + 2, v);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// RMS difference of left(u) and right(u − d − shift) over the pixels that both cameras see.
inline double warp_rms(const SyntheticPair& pair, double shift) {
  double sum = 0;
  int count = 0;
  for (int v = 0; v < pair.left.height; ++v) {
    for (int u = 0; u < pair.left.width; ++u) {
      const double target = u - pair.disparity(u, v) - shift;
      if (pair.visible(u, v) == 0 || !(target >= 2 && target <= pair.left.width - 4)) continue;
      const double difference = grey(pair.left, u, v) - cubic_sample(pair.right, target, v);
      sum += difference * difference;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace roadstereo::synth

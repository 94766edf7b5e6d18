#pragma once

#include <array>
#include <vector>

#include "roadstereo/synth.hpp"
#include "synth/hash.hpp"

namespace roadstereo::synth {

/// Random polyline of a crack: it wanders around its heading (0: along the road) in steps of 3 cm.
inline std::vector<std::array<double, 2>> wandering_line(double x, double y, double heading_rad, double length_m,
                                                         std::uint64_t seed) {
  constexpr double step = 0.03;
  RandomSequence random(seed);
  std::vector<std::array<double, 2>> points{{x, y}};
  double bend = 0;
  const int steps = static_cast<int>(std::ceil(length_m / step));
  for (int i = 0; i < steps; ++i) {
    // First-order autoregressive process, so that the line does not curl up.
    bend = 0.75 * bend + random.uniform(-0.6, 0.6);
    x += step * std::sin(heading_rad + bend);
    y += step * std::cos(heading_rad + bend);
    points.push_back({x, y});
  }
  return points;
}

/// Families of rigs that scenes are based on.
Rig uav_rig();
Rig street_rig();
Rig close_rig();

}  // namespace roadstereo::synth

#include "evaluate/rutted_scenes.hpp"

#include <cmath>
#include <random>
#include <string>

#include "core/degrees.hpp"
#include "synth/hash.hpp"

namespace roadstereo::cli {

synth::Scene rutted_scene(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double lower, double upper) {
    return lower + (upper - lower) * synth::unit_interval(random());
  };
  synth::Scene scene = synth::random_scene(seed, true);
  scene.name = "rutted_" + std::to_string(seed);
  scene.rig.width = 640;
  scene.rig.height = 360;
  scene.rig.focal_px = uniform(400, 600);
  scene.rig.baseline_m = uniform(0.12, 0.35);
  scene.rig.camera_height_m = uniform(1.4, 3.5);
  scene.rig.pitch_deg = uniform(30, 75);
  scene.rig.roll_deg = uniform(-4, 4);
  scene.road.camber = uniform(0, 0.004);
  scene.road.blobs.clear();
  scene.road.cracks.clear();
  scene.road.kerbs.clear();
  constexpr double ahead_m = 3, reach_m = 60;  // of the camera, where the tracks are placed, and of their ends
  const double heading = to_radians(uniform(-12, 12));
  const double middle_m = uniform(-0.4, 0.4), gauge_m = uniform(1.55, 1.85);
  const bool both = uniform(0, 1) < 0.6;
  synth::Rut rut;
  rut.width_m = uniform(0.45, 1);
  rut.depth_m = uniform(0.007, 0.035);
  for (const double side : {-0.5, 0.5}) {
    const double x = middle_m + (both ? side * gauge_m : 0);
    rut.from_m = {x - reach_m * std::sin(heading), ahead_m - reach_m * std::cos(heading)};
    rut.to_m = {x + reach_m * std::sin(heading), ahead_m + reach_m * std::cos(heading)};
    scene.road.ruts.push_back(rut);
    if (!both) break;
  }
  return scene;
}

}  // namespace roadstereo::cli

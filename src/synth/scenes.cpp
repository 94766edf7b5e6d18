#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/edit_distance.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"
#include "synth/scene_parts.hpp"

namespace roadstereo::synth {

Rig uav_rig() {
  Rig rig;
  rig.camera_height_m = 2.6;
  return rig;
}

Rig street_rig() {
  Rig rig;
  rig.width = 1242;
  rig.height = 375;
  rig.focal_px = 721.5;
  rig.baseline_m = 0.5327;
  rig.camera_height_m = 1.65;
  rig.pitch_deg = 4;
  return rig;
}

Rig close_rig() {
  Rig rig;
  rig.width = 1040;
  rig.height = 520;
  rig.focal_px = 1381.0 * 1040 / 2079;
  rig.baseline_m = 0.119;
  rig.camera_height_m = 0.8;
  rig.pitch_deg = 68;
  return rig;
}

namespace {

Scene demo() {
  Scene scene;
  scene.supersampling = 2;
  scene.rig.width = 960;
  scene.rig.height = 540;
  scene.rig.focal_px = 640;
  scene.rig.camera_height_m = 2.4;
  scene.rig.pitch_deg = 58;
  scene.rig.roll_deg = 3;
  scene.rig.x_m = -0.35;
  scene.road.camber = 0.004;
  scene.road.blobs = {{0.30, 1.25, 0.30, 0.075, 0.30, 0.22, 7},
                      {-0.85, 1.75, 0.19, 0.050, 0.35, 0.30, 12},
                      {0.75, 2.25, 0.28, -0.035, 0.20, 0.70, 5}};
  scene.road.cracks = {{wandering_line(-0.55, 0.55, -0.45, 0.9, 3), 0.014, 0.025, 0.6, 3},
                       {wandering_line(-0.20, 2.05, 1.15, 0.8, 9), 0.010, 0.020, 0.6, 9}};
  return scene;
}

Scene uav() {
  Scene scene;
  scene.rig = uav_rig();
  scene.road.camber = 0.004;
  scene.road.blobs = {{0.45, 1.35, 0.35, 0.08, 0.30, 0.25, 21}, {-0.75, 1.95, 0.25, 0.06, 0.30, 0.30, 22}};
  scene.road.cracks = {{wandering_line(-0.9, 0.5, 0.35, 1.1, 4), 0.016, 0.025, 0.6, 4}};
  return scene;
}

Scene street() {
  Scene scene;
  scene.rig = street_rig();
  scene.road.kerbs = {{1.9, 0.12, 0.03}};
  scene.road.blobs = {{0.35, 6.6, 0.42, 0.09, 0.30, 0.25, 31},
                      {-0.80, 9.5, 0.50, 0.10, 0.30, 0.25, 32},
                      {0.60, 13.0, 0.60, -0.06, 0.20, 0.70, 33}};
  return scene;
}

Scene nadir() {
  Scene scene;
  scene.rig = uav_rig();
  scene.rig.camera_height_m = 2.07;
  scene.rig.pitch_deg = 90;
  scene.road.blobs = {{0.35, 0.15, 0.35, 0.08, 0.30, 0.25, 41}, {-0.75, -0.25, 0.22, 0.05, 0.30, 0.30, 42}};
  scene.road.cracks = {{wandering_line(-0.4, -0.7, -0.2, 1.3, 5), 0.014, 0.02, 0.6, 5}};
  return scene;
}

Scene close() {
  Scene scene;
  scene.supersampling = 2;
  scene.rig = close_rig();
  scene.road.lane_marking = false;
  scene.road.blobs = {{0.10, 0.33, 0.17, 0.045, 0.30, 0.30, 51}};
  scene.road.cracks = {{wandering_line(-0.33, 0.10, 0.25, 0.5, 6), 0.006, 0.012, 0.6, 6}};
  return scene;
}

Scene flat() {
  Scene scene;
  scene.rig = uav_rig();
  scene.road.lane_marking = false;
  return scene;
}

Scene degraded_uav(const std::function<void(Scene&)>& degrade) {
  Scene scene = uav();
  degrade(scene);
  return scene;
}

/// Variants of the UAV scene with one difficulty each.
std::vector<std::pair<std::string, std::function<void(Scene&)>>> uav_variants() {
  return {
      {"low_texture",
       [](Scene& s) {
         s.road.texture_contrast = 0.12;
         s.road.lane_marking = false;
       }},
      {"noise", [](Scene& s) { s.degradation.noise_grey = 6; }},
      {"blur", [](Scene& s) { s.degradation.blur_px = 1.5; }},
      {"motion_blur",
       [](Scene& s) {
         s.degradation.motion_blur_px = 7;
         s.degradation.motion_blur_angle_deg = 70;
       }},
      {"overexposed", [](Scene& s) { s.degradation.exposure = 2.1; }},
      {"gain", [](Scene& s) { s.degradation.gain_difference = 0.15; }},
      {"rolled", [](Scene& s) { s.rig.roll_deg = 8; }},
      {"row_offset", [](Scene& s) { s.degradation.row_offset_px = 0.5; }},
  };
}

std::vector<std::pair<std::string, std::function<Scene()>>> catalogue() {
  std::vector<std::pair<std::string, std::function<Scene()>>> scenes = {
      {"demo", demo}, {"uav", uav}, {"street", street}, {"nadir", nadir}, {"close", close}, {"flat", flat}};
  for (const auto& entry : uav_variants()) {
    scenes.emplace_back(entry.first, [degrade = entry.second] { return degraded_uav(degrade); });
  }
  return scenes;
}

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : catalogue()) names.push_back(entry.first);
  return names;
}

Scene named_scene(const std::string& name) {
  const auto scenes = catalogue();
  for (const auto& [scene_name, make] : scenes) {
    if (scene_name != name) continue;
    Scene scene = make();
    scene.name = name;
    return scene;
  }
  const auto nearest = std::min_element(scenes.begin(), scenes.end(), [&](const auto& a, const auto& b) {
    return edit_distance(a.first, name) < edit_distance(b.first, name);
  });
  fail("there is no scene named \"", name, "\"; did you mean \"", nearest->first, "\"?");
}

Scene next_frame(const Scene& scene, int frame, double step_m) {
  if (frame < 0) fail("frame is ", frame, "; it must not be negative");
  if (!std::isfinite(step_m)) fail("step_m is ", step_m, "; it must be a finite number");
  // Slow sine waves of incommensurate periods, so that the motion does not repeat; all are 0 at frame 0.
  const double t = frame;
  Scene next = scene;
  next.rig.y_m += t * step_m;
  next.rig.x_m += 0.02 * std::sin(0.047 * t);
  next.rig.camera_height_m *= 1 + 0.012 * std::sin(0.131 * t);
  next.rig.roll_deg = std::clamp(scene.rig.roll_deg + 0.9 * std::sin(0.093 * t), -60.0, 60.0);
  // The pitch is clamped: a camera that looks straight down must not tilt backwards.
  const double pitch_change = 0.5 * std::sin(0.171 * t);
  next.rig.pitch_deg = std::clamp(scene.rig.pitch_deg + pitch_change, 0.0, 90.0);
  next.degradation.noise_seed += static_cast<std::uint32_t>(frame);
  return next;
}

}  // namespace roadstereo::synth

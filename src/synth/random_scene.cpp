#include <algorithm>
#include <cmath>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/height_field.hpp"
#include "synth/scene_parts.hpp"

namespace roadstereo::synth {
namespace {

/// Sizes are multiples of 8, as cameras have them.
int size_near(Draws& draws, int size) {
  return 8 * draws.integer(size / 8 - 6, size / 8 + 6);
}

Rig draw_uav(Draws& draws) {
  Rig rig = uav_rig();
  rig.camera_height_m = draws.uniform(2, 5);
  rig.pitch_deg = draws.uniform(45, 80);
  rig.roll_deg = draws.uniform(-10, 10);
  return rig;
}

Rig draw_nadir(Draws& draws) {
  Rig rig = uav_rig();
  rig.camera_height_m = draws.uniform(1.5, 4);
  rig.pitch_deg = draws.uniform(84, 90);
  rig.roll_deg = draws.uniform(-10, 10);
  return rig;
}

Rig draw_close(Draws& draws) {
  Rig rig = close_rig();
  rig.focal_px *= 640.0 / rig.width;
  rig.camera_height_m = draws.uniform(0.7, 1.0);
  rig.pitch_deg = draws.uniform(60, 85);
  rig.roll_deg = draws.uniform(-6, 6);
  return rig;
}

Rig draw_street(Draws& draws) {
  Rig rig = street_rig();
  rig.focal_px *= 640.0 / rig.width;
  rig.camera_height_m = draws.uniform(1.3, 1.9);
  rig.pitch_deg = draws.uniform(2, 8);
  rig.roll_deg = draws.uniform(-3, 3);
  return rig;
}

Rig draw_rig(Draws& draws) {
  const double family = draws.uniform(0, 1);
  Rig rig = family < 0.5    ? draw_uav(draws)
            : family < 0.65 ? draw_nadir(draws)
            : family < 0.8  ? draw_close(draws)
                            : draw_street(draws);
  rig.width = size_near(draws, 640);
  rig.height = size_near(draws, 360);
  rig.focal_px *= rig.width / 640.0 * draws.uniform(0.9, 1.1);
  return rig;
}

/// A place that the left camera sees in the middle of its picture, and the size of a pixel there.
struct Target {
  Vec3 point;
  double pixel_m = 0;
};

Target draw_target(Draws& draws, const Rig& rig) {
  const RoadModel plane = plane_model(rig);
  constexpr int tries = 100;
  double u = 0.5 * (rig.width - 1);
  double v = rig.height - 1;
  for (int i = 0; i < tries; ++i) {
    const double column = rig.width * draws.uniform(0.2, 0.85);
    const double row = rig.height * draws.uniform(0.15, 0.9);
    // In street views the rows near the horizon see nothing of a pothole: keep to 16 camera heights.
    if (plane.disparity(column, row) < rig.focal_px * rig.baseline_m / (16 * rig.camera_height_m)) continue;
    u = column;
    v = row;
    break;
  }
  const double depth = rig.focal_px * rig.baseline_m / plane.disparity(u, v);
  return {left_camera(rig).ray(u, v).at(depth), depth / rig.focal_px};
}

Blob draw_blob(Draws& draws, const Rig& rig) {
  const Target target = draw_target(draws, rig);
  Blob blob;
  blob.x_m = target.point.x;
  blob.y_m = target.point.y;
  blob.radius_m = std::clamp(target.pixel_m * draws.uniform(22, 75), 0.06, 0.7);
  blob.depth_m = std::clamp(blob.radius_m * draws.uniform(0.15, 0.35), 0.015, 0.12);
  blob.irregularity = draws.uniform(0.1, 0.4);
  blob.wall_share = draws.uniform(0.15, 0.5);
  if (draws.chance(0.25)) {
    blob.depth_m *= -0.6;
    blob.wall_share = draws.uniform(0.5, 0.9);
  }
  blob.seed = draws.seed();
  return blob;
}

Crack draw_crack(Draws& draws, const Rig& rig) {
  const Target target = draw_target(draws, rig);
  Crack crack;
  const double length = std::clamp(target.pixel_m * draws.uniform(80, 250), 0.2, 2.5);
  crack.points_m = wandering_line(target.point.x, target.point.y, draws.uniform(-1.5, 1.5), length, draws.seed());
  crack.width_m = std::clamp(target.pixel_m * draws.uniform(1.5, 4), 0.004, 0.03);
  crack.depth_m = crack.width_m * draws.uniform(1, 2);
  crack.irregularity = draws.uniform(0.3, 0.8);
  crack.seed = draws.seed();
  return crack;
}

Degradation draw_degradation(Draws& draws) {
  Degradation wear;
  wear.noise_grey = draws.uniform(0.5, 4);
  if (draws.chance(0.3)) wear.blur_px = draws.uniform(0.4, 1.2);
  if (draws.chance(0.25)) {
    wear.motion_blur_px = draws.uniform(1, 6);
    wear.motion_blur_angle_deg = draws.uniform(-90, 90);
  }
  if (draws.chance(0.4)) wear.gain_difference = draws.uniform(-0.12, 0.12);
  if (draws.chance(0.3)) wear.exposure = draws.uniform(0.5, 1.7);
  if (draws.chance(0.25)) wear.row_offset_px = draws.uniform(-0.6, 0.6);
  wear.noise_seed = draws.seed();
  return wear;
}

}  // namespace

Scene random_scene(std::uint64_t seed, bool degraded) {
  Draws draws(seed);
  Scene scene;
  scene.name = "random_" + std::to_string(seed);
  scene.rig = draw_rig(draws);
  scene.road.seed = draws.seed();
  scene.road.camber = draws.chance(0.5) ? draws.uniform(0, 0.004) : 0;
  scene.road.lane_marking = draws.chance(0.5);
  scene.road.texture_contrast = draws.uniform(0.7, 1.2);
  const int blobs = draws.integer(1, 3);
  for (int i = 0; i < blobs; ++i) scene.road.blobs.push_back(draw_blob(draws, scene.rig));
  const int cracks = draws.integer(0, 2);
  for (int i = 0; i < cracks; ++i) scene.road.cracks.push_back(draw_crack(draws, scene.rig));
  if (scene.rig.pitch_deg < 10 && draws.chance(0.6)) {
    scene.road.kerbs.push_back({draws.uniform(1.5, 3), draws.uniform(0.08, 0.18), draws.uniform(0.01, 0.05)});
  }
  if (degraded) {
    scene.degradation = draw_degradation(draws);
    scene.road.texture_contrast *= draws.uniform(0.4, 1);
  }
  return scene;
}

}  // namespace roadstereo::synth

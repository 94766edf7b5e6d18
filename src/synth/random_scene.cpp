#include <algorithm>
#include <cmath>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/height_field.hpp"
#include "synth/scene_parts.hpp"

namespace roadstereo::synth {
namespace {

/// Random image size near `size`, a multiple of 8.
int size_near(RandomSequence& random, int size) {
  return 8 * random.integer(size / 8 - 6, size / 8 + 6);
}

Rig draw_uav(RandomSequence& random) {
  Rig rig = uav_rig();
  rig.camera_height_m = random.uniform(2, 5);
  rig.pitch_deg = random.uniform(45, 80);
  rig.roll_deg = random.uniform(-10, 10);
  return rig;
}

Rig draw_nadir(RandomSequence& random) {
  Rig rig = uav_rig();
  rig.camera_height_m = random.uniform(1.5, 4);
  rig.pitch_deg = random.uniform(84, 90);
  rig.roll_deg = random.uniform(-10, 10);
  return rig;
}

Rig draw_close(RandomSequence& random) {
  Rig rig = close_rig();
  rig.focal_px *= 640.0 / rig.width;
  rig.camera_height_m = random.uniform(0.7, 1.0);
  rig.pitch_deg = random.uniform(60, 85);
  rig.roll_deg = random.uniform(-6, 6);
  return rig;
}

Rig draw_street(RandomSequence& random) {
  Rig rig = street_rig();
  rig.focal_px *= 640.0 / rig.width;
  rig.camera_height_m = random.uniform(1.3, 1.9);
  rig.pitch_deg = random.uniform(2, 8);
  rig.roll_deg = random.uniform(-3, 3);
  return rig;
}

Rig draw_rig(RandomSequence& random) {
  const double family = random.uniform(0, 1);
  Rig rig = family < 0.5    ? draw_uav(random)
            : family < 0.65 ? draw_nadir(random)
            : family < 0.8  ? draw_close(random)
                            : draw_street(random);
  rig.width = size_near(random, 640);
  rig.height = size_near(random, 360);
  rig.focal_px *= rig.width / 640.0 * random.uniform(0.9, 1.1);
  return rig;
}

/// Point on the road in the central part of the left image, and the size of a pixel there.
struct Target {
  Vec3 point;
  double pixel_m = 0;
};

Target draw_target(RandomSequence& random, const Rig& rig) {
  const DisparityPlane plane = road_disparity_plane(rig);
  constexpr int max_attempts = 100;
  double u = 0.5 * (rig.width - 1);
  double v = rig.height - 1;
  for (int i = 0; i < max_attempts; ++i) {
    const double column = rig.width * random.uniform(0.2, 0.85);
    const double row = rig.height * random.uniform(0.15, 0.9);
    // Near the horizon of street views potholes are too small: the maximum distance is 16 camera heights.
    if (plane.disparity(column, row) < rig.focal_px * rig.baseline_m / (16 * rig.camera_height_m)) continue;
    u = column;
    v = row;
    break;
  }
  const double depth = rig.focal_px * rig.baseline_m / plane.disparity(u, v);
  return {left_camera(rig).ray(u, v).at(depth), depth / rig.focal_px};
}

Blob draw_blob(RandomSequence& random, const Rig& rig) {
  const Target target = draw_target(random, rig);
  Blob blob;
  blob.x_m = target.point.x;
  blob.y_m = target.point.y;
  blob.radius_m = std::clamp(target.pixel_m * random.uniform(22, 75), 0.06, 0.7);
  blob.depth_m = std::clamp(blob.radius_m * random.uniform(0.15, 0.35), 0.015, 0.12);
  blob.irregularity = random.uniform(0.1, 0.4);
  blob.wall_share = random.uniform(0.15, 0.5);
  if (random.bernoulli(0.25)) {
    blob.depth_m *= -0.6;
    blob.wall_share = random.uniform(0.5, 0.9);
  }
  blob.seed = random.seed();
  return blob;
}

Crack draw_crack(RandomSequence& random, const Rig& rig) {
  const Target target = draw_target(random, rig);
  Crack crack;
  const double length = std::clamp(target.pixel_m * random.uniform(80, 250), 0.2, 2.5);
  crack.points_m = wandering_line(target.point.x, target.point.y, random.uniform(-1.5, 1.5), length, random.seed());
  crack.width_m = std::clamp(target.pixel_m * random.uniform(1.5, 4), 0.004, 0.03);
  crack.depth_m = crack.width_m * random.uniform(1, 2);
  crack.irregularity = random.uniform(0.3, 0.8);
  crack.seed = random.seed();
  return crack;
}

Degradation draw_degradation(RandomSequence& random) {
  Degradation degradation;
  degradation.noise_grey = random.uniform(0.5, 4);
  if (random.bernoulli(0.3)) degradation.blur_px = random.uniform(0.4, 1.2);
  if (random.bernoulli(0.25)) {
    degradation.motion_blur_px = random.uniform(1, 6);
    degradation.motion_blur_angle_deg = random.uniform(-90, 90);
  }
  if (random.bernoulli(0.4)) degradation.gain_difference = random.uniform(-0.12, 0.12);
  if (random.bernoulli(0.3)) degradation.exposure = random.uniform(0.5, 1.7);
  if (random.bernoulli(0.25)) degradation.row_offset_px = random.uniform(-0.6, 0.6);
  degradation.noise_seed = random.seed();
  return degradation;
}

}  // namespace

Scene random_scene(std::uint64_t seed, bool degraded) {
  RandomSequence random(seed);
  Scene scene;
  scene.name = "random_" + std::to_string(seed);
  scene.rig = draw_rig(random);
  scene.road.seed = random.seed();
  scene.road.camber = random.bernoulli(0.5) ? random.uniform(0, 0.004) : 0;
  scene.road.lane_marking = random.bernoulli(0.5);
  scene.road.texture_contrast = random.uniform(0.7, 1.2);
  const int blobs = random.integer(1, 3);
  for (int i = 0; i < blobs; ++i) scene.road.blobs.push_back(draw_blob(random, scene.rig));
  const int cracks = random.integer(0, 2);
  for (int i = 0; i < cracks; ++i) scene.road.cracks.push_back(draw_crack(random, scene.rig));
  if (scene.rig.pitch_deg < 10 && random.bernoulli(0.6)) {
    scene.road.kerbs.push_back({random.uniform(1.5, 3), random.uniform(0.08, 0.18), random.uniform(0.01, 0.05)});
  }
  if (degraded) {
    scene.degradation = draw_degradation(random);
    scene.road.texture_contrast *= random.uniform(0.4, 1);
  }
  return scene;
}

}  // namespace roadstereo::synth

#include <algorithm>
#include <cmath>
#include <string>

#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/scene_parts.hpp"

namespace roadstereo::synth {
namespace {

/// Rig of a car, a truck or a mast beside the road.
Rig draw_vehicle(RandomSequence& random) {
  Rig rig;
  rig.width = 640;
  rig.height = 8 * random.integer(22, 50);
  rig.focal_px = random.uniform(300, 560);
  rig.baseline_m = random.bernoulli(0.5) ? random.uniform(0.1, 0.25) : random.uniform(0.25, 0.55);
  rig.camera_height_m = random.uniform(1.1, 2.8);
  rig.pitch_deg = random.uniform(0, 16);
  rig.roll_deg = random.uniform(-4, 4);
  return rig;
}

Rig draw_drone(RandomSequence& random) {
  Rig rig;
  rig.width = 640;
  rig.height = 8 * random.integer(40, 60);
  rig.focal_px = random.uniform(300, 700);
  rig.baseline_m = random.uniform(0.08, 0.25);
  rig.camera_height_m = rig.baseline_m * random.uniform(8, 25);
  rig.pitch_deg = random.bernoulli(0.3) ? random.uniform(84, 90) : random.uniform(35, 84);
  rig.roll_deg = random.uniform(-12, 12);
  return rig;
}

/// Parked cars along one side of a street: a body and a cabin each.
void add_cars(RandomSequence& random, double x_m, double from_m, std::vector<Box>& boxes) {
  double y = from_m;
  const int cars = random.integer(1, 6);
  for (int i = 0; i < cars; ++i) {
    Box body;
    body.x_m = x_m + random.uniform(-0.15, 0.15);
    body.length_m = random.uniform(3.6, 5.2);
    body.width_m = random.uniform(1.6, 2.0);
    body.y_m = y + body.length_m / 2;
    body.bottom_m = 0.18;
    body.top_m = random.uniform(0.8, 1.0);
    body.grey = random.uniform(25, 220);
    body.texture_contrast = random.uniform(0.02, 0.3);
    body.seed = random.seed();
    boxes.push_back(body);
    Box cabin = body;
    cabin.length_m *= 0.55;
    cabin.width_m *= 0.85;
    cabin.bottom_m = body.top_m;
    cabin.top_m = body.top_m + random.uniform(0.45, 0.9);
    cabin.grey = random.uniform(20, 90);
    boxes.push_back(cabin);
    y += body.length_m + random.uniform(0.8, 8);
  }
}

/// Pavement, and a house front, a hedge or nothing behind it. `side`: 1 for the right, −1 for the left.
void add_roadside(RandomSequence& random, int side, double edge_m, std::vector<Box>& boxes) {
  constexpr double length_m = 400;
  double x = edge_m;
  if (random.bernoulli(0.6)) {
    Box pavement;
    pavement.width_m = random.uniform(1, 3);
    pavement.x_m = side * (x + pavement.width_m / 2);
    pavement.y_m = 0;
    pavement.length_m = length_m;
    pavement.bottom_m = -1;
    pavement.top_m = random.uniform(0.06, 0.2);
    pavement.grey = random.uniform(90, 170);
    pavement.texture_contrast = random.uniform(0.3, 1);
    pavement.seed = random.seed();
    boxes.push_back(pavement);
    x += pavement.width_m;
  }
  if (random.bernoulli(0.55)) {
    Box front;
    front.width_m = 20;
    front.x_m = side * (x + random.uniform(0, 4) + front.width_m / 2);
    front.y_m = 0;
    front.length_m = length_m;
    front.bottom_m = -2;
    const bool is_hedge = random.bernoulli(0.3);
    front.top_m = is_hedge ? random.uniform(0.8, 2.5) : random.uniform(4, 14);
    front.grey = random.uniform(50, 190);
    front.texture_contrast = is_hedge ? random.uniform(1, 2) : random.uniform(0.1, 0.8);
    front.panel_m = is_hedge ? 0 : random.uniform(1.2, 3);
    front.seed = random.seed();
    boxes.push_back(front);
  }
}

/// Bushes and tufts beyond an edge of the road.
void add_bushes(RandomSequence& random, int side, double edge_m, double range_m, std::vector<Blob>& blobs) {
  const int bushes = random.integer(2, 10);
  for (int i = 0; i < bushes; ++i) {
    Blob bush;
    bush.radius_m = random.uniform(0.1, 0.5);
    bush.x_m = side * (edge_m + bush.radius_m * 1.5 + random.uniform(0, 1.5));
    bush.y_m = random.uniform(0, range_m);
    bush.depth_m = -bush.radius_m * random.uniform(0.3, 1);
    bush.irregularity = random.uniform(0.2, 0.5);
    bush.wall_share = random.uniform(0.3, 0.9);
    bush.seed = random.seed();
    bush.is_damage = false;
    blobs.push_back(bush);
  }
}

/// Potholes and bumps between two edges, within `range_m` ahead.
void add_damage(RandomSequence& random, const Rig& rig, double half_width_m, std::vector<Blob>& blobs) {
  const DisparityPlane plane = road_disparity_plane(rig);
  const int count = random.integer(0, 4);
  for (int i = 0; i < count; ++i) {
    const double u = rig.width * random.uniform(0.15, 0.9), v = rig.height * random.uniform(0.2, 0.95);
    const double disparity = plane.disparity(u, v);
    if (disparity < rig.focal_px * rig.baseline_m / (10 * rig.camera_height_m)) continue;
    const double depth = rig.focal_px * rig.baseline_m / disparity;
    const Vec3 point = left_camera(rig).ray(u, v).at(depth);
    if (std::abs(point.x) > half_width_m) continue;
    Blob blob;
    blob.x_m = point.x;
    blob.y_m = point.y;
    blob.radius_m = std::clamp(depth / rig.focal_px * random.uniform(15, 80), 0.05, 0.8);
    blob.depth_m = std::clamp(blob.radius_m * random.uniform(0.08, 0.35), 0.008, 0.15);
    blob.irregularity = random.uniform(0.1, 0.45);
    blob.wall_share = random.uniform(0.1, 0.6);
    if (random.bernoulli(0.25)) blob.depth_m *= -0.6;
    blob.seed = random.seed();
    blobs.push_back(blob);
  }
}

Degradation draw_degradation(RandomSequence& random) {
  Degradation degradation;
  degradation.noise_seed = random.seed();
  degradation.noise_grey = random.uniform(0.5, 2);
  if (random.bernoulli(0.5)) degradation.full_well_electrons = 200 * std::pow(100, random.uniform(0, 1));
  if (random.bernoulli(0.3)) degradation.blur_px = random.uniform(0.5, 3);
  if (random.bernoulli(0.25)) {
    degradation.motion_blur_px = random.uniform(2, 10);
    degradation.motion_blur_angle_deg = random.uniform(-90, 90);
  }
  if (random.bernoulli(0.4)) degradation.gain_difference = random.uniform(-0.2, 0.2);
  if (random.bernoulli(0.4)) degradation.exposure = random.uniform(0.35, 1.8);
  if (random.bernoulli(0.3)) degradation.row_offset_px = random.uniform(-0.5, 0.5);
  if (random.bernoulli(0.3)) degradation.row_rotation_deg = random.uniform(-0.08, 0.08);
  if (random.bernoulli(0.1)) degradation.snowflakes = random.integer(30, 400);
  if (random.bernoulli(0.3)) degradation.jpeg_quality = random.integer(30, 90);
  return degradation;
}

void draw_street(RandomSequence& random, Scene& scene) {
  scene.rig = draw_vehicle(random);
  Road& road = scene.road;
  const double left = random.uniform(1.8, 6), right = random.uniform(1.8, 6);
  road.verge_left_m = -left;
  road.verge_right_m = right;
  for (const int side : {-1, 1}) {
    const double edge = side < 0 ? left : right;
    add_roadside(random, side, edge, road.boxes);
    if (random.bernoulli(0.55)) add_cars(random, side * (edge - 1), random.uniform(3, 9), road.boxes);
  }
  if (random.bernoulli(0.3)) road.crest = random.uniform(-0.004, 0.004);
  if (random.bernoulli(0.15)) {
    Box island;
    island.x_m = random.uniform(-1, 1);
    island.y_m = random.uniform(12, 25);
    island.width_m = random.uniform(0.8, 2);
    island.length_m = random.uniform(2, 12);
    island.bottom_m = -1;
    island.top_m = random.uniform(0.1, 0.2);
    island.grey = random.uniform(80, 200);
    island.texture_contrast = random.uniform(0.3, 1);
    road.boxes.push_back(island);
  }
  if (random.bernoulli(0.2)) scene.degradation.bonnet_share = random.uniform(0.05, 0.25);
}

void draw_flyover(RandomSequence& random, Scene& scene) {
  scene.rig = draw_drone(random);
  Road& road = scene.road;
  const double height = scene.rig.camera_height_m;
  if (random.bernoulli(0.4)) road.verge_right_m = height * random.uniform(0.2, 1);
  if (random.bernoulli(0.3)) road.verge_left_m = -height * random.uniform(0.2, 1);
  const double range = height * (scene.rig.pitch_deg > 60 ? 2 : 5);
  if (road.verge_right_m < height) add_bushes(random, 1, road.verge_right_m, range, road.blobs);
  if (-road.verge_left_m < height) add_bushes(random, -1, -road.verge_left_m, range, road.blobs);
  // A camera close above the road sees no car; one that is higher may.
  if (height > 2.5 && random.bernoulli(0.25)) {
    add_cars(random, (random.bernoulli(0.5) ? 1 : -1) * height * random.uniform(0.5, 0.9), 0.3 * height, road.boxes);
  }
}

}  // namespace

Scene random_wide_scene(std::uint64_t seed) {
  RandomSequence random(mix64(seed) ^ 0x77696465u);
  Scene scene;
  scene.name = "wide_" + std::to_string(seed);
  scene.supersampling = 2;
  scene.degradation = draw_degradation(random);
  Road& road = scene.road;
  road.seed = random.seed();
  random.bernoulli(0.5) ? draw_street(random, scene) : draw_flyover(random, scene);
  road.camber = random.bernoulli(0.6) ? random.uniform(0, 0.008) : 0;
  road.texture_contrast = random.uniform(0.3, 1.3);
  road.lane_marking = random.bernoulli(0.6);
  road.paint_grey = random.uniform(150, 420);
  if (random.bernoulli(0.35)) road.shade = random.uniform(0.2, 0.8);
  if (random.bernoulli(0.2)) road.wet_share = random.uniform(0.05, 0.5);
  add_damage(random, scene.rig, std::min(-road.verge_left_m, road.verge_right_m), road.blobs);
  return scene;
}

}  // namespace roadstereo::synth

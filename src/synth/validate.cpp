#include <algorithm>
#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/height_field.hpp"

namespace roadstereo::synth {
namespace {

/// Throws unless low ≤ value ≤ high; the sentence names the figure, e.g. "blob 2: depth_m".
void require(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  fail(name, " is ", value, "; it must be between ", low, " and ", high);
}

constexpr double road_end_m = 1e5;

std::string member(const char* kind, std::size_t index, const char* name) {
  return std::string(kind) + " " + std::to_string(index + 1) + ": " + name;
}

void check_blobs(const std::vector<Blob>& blobs) {
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    const Blob& blob = blobs[i];
    const auto name = [&](const char* figure) { return member("blob", i, figure); };
    require(name("x_m"), blob.x_m, -road_end_m, road_end_m);
    require(name("y_m"), blob.y_m, -road_end_m, road_end_m);
    require(name("radius_m"), blob.radius_m, 0.005, 20);
    require(name("depth_m"), blob.depth_m, -2, 2);
    if (blob.depth_m == 0) fail(name("depth_m"), " is 0; it must be above 0 for a pothole or below 0 for a bump");
    require(name("irregularity"), blob.irregularity, 0, 0.5);
    require(name("wall_share"), blob.wall_share, 0.02, 1);
  }
}

void check_cracks(const std::vector<Crack>& cracks) {
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    const Crack& crack = cracks[i];
    const auto name = [&](const char* figure) { return member("crack", i, figure); };
    if (crack.points_m.size() < 2) {
      fail(name("points_m"), " has ", crack.points_m.size(), " points; it must have at least 2");
    }
    for (const auto& point : crack.points_m) {
      require(name("points_m"), point[0], -road_end_m, road_end_m);
      require(name("points_m"), point[1], -road_end_m, road_end_m);
    }
    for (std::size_t k = 1; k < crack.points_m.size(); ++k) {
      const auto& a = crack.points_m[k - 1];
      const auto& b = crack.points_m[k];
      if (std::hypot(b[0] - a[0], b[1] - a[1]) < 1e-6) {
        fail(name("points_m"), " has the points ", k, " and ", k + 1, " in one place; they must differ");
      }
    }
    require(name("width_m"), crack.width_m, 0.0005, 1);
    require(name("depth_m"), crack.depth_m, 0.0001, 1);
    require(name("irregularity"), crack.irregularity, 0, 0.9);
  }
}

void check_kerbs(const std::vector<Kerb>& kerbs) {
  for (std::size_t i = 0; i < kerbs.size(); ++i) {
    require(member("kerb", i, "x_m"), kerbs[i].x_m, -road_end_m, road_end_m);
    require(member("kerb", i, "height_m"), kerbs[i].height_m, -1, 1);
    require(member("kerb", i, "width_m"), kerbs[i].width_m, 0.001, 10);
  }
}

void check_road(const Road& road) {
  require("camber", road.camber, -0.1, 0.1);
  require("texture_contrast", road.texture_contrast, 0, 4);
  check_blobs(road.blobs);
  check_cracks(road.cracks);
  check_kerbs(road.kerbs);
  constexpr std::size_t most_damages = std::numeric_limits<std::uint16_t>::max();
  if (road.blobs.size() + road.cracks.size() > most_damages) {
    fail("the road has ", road.blobs.size() + road.cracks.size(), " damages; it must have at most ", most_damages);
  }
}

void check_degradation(const Degradation& wear) {
  require("noise_grey", wear.noise_grey, 0, 100);
  require("blur_px", wear.blur_px, 0, 50);
  require("motion_blur_px", wear.motion_blur_px, 0, 200);
  require("motion_blur_angle_deg", wear.motion_blur_angle_deg, -360, 360);
  require("gain_difference", wear.gain_difference, -0.95, 10);
  require("exposure", wear.exposure, 0.01, 100);
  require("row_offset_px", wear.row_offset_px, -100, 100);
}

/// Both cameras must be in the open air, or no ray would ever meet the road from above.
void check_clearance(const Rig& rig, const Road& road) {
  constexpr double least = 0.02;
  const HeightField field(road);
  for (const Camera& camera : {left_camera(rig), right_camera(rig, 0)}) {
    const double surface = std::max(field.undamaged(camera.origin.x), field.height(camera.origin.x, camera.origin.y));
    if (camera.origin.z - surface < least) {
      fail("camera_height_m is ", rig.camera_height_m, ", which leaves a camera ", camera.origin.z - surface,
           " m above the surface below it; it must be at least ", least, " m");
    }
  }
}

}  // namespace

void Rig::validate() const {
  require("width", width, 32, 8192);
  require("height", height, 32, 8192);
  require("focal_px", focal_px, 0.2 * width, 50.0 * width);
  require("baseline_m", baseline_m, 0.005, 10);
  require("camera_height_m", camera_height_m, 0.05, 500);
  require("pitch_deg", pitch_deg, 0, 90);
  require("roll_deg", roll_deg, -60, 60);
  require("x_m", x_m, -road_end_m, road_end_m);
  require("y_m", y_m, -road_end_m, road_end_m);
}

void Scene::validate() const {
  rig.validate();
  check_road(road);
  check_degradation(degradation);
  require("supersampling", supersampling, 1, 8);
  check_clearance(rig, road);
}

}  // namespace roadstereo::synth

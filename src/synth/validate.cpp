#include <algorithm>
#include <cmath>
#include <limits>

#include "core/image_limits.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"
#include "synth/camera.hpp"
#include "synth/height_field.hpp"

namespace roadstereo::synth {
namespace {

/// Throws Error unless lower ≤ value ≤ upper; `name` is for example "blob 2: depth_m".
void require_in_range(const std::string& name, double value, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  fail(name, " is ", value, "; it must be between ", lower, " and ", upper);
}

constexpr double max_coordinate_m = 1e5;

std::string member(const char* kind, std::size_t index, const char* name) {
  return std::string(kind) + " " + std::to_string(index + 1) + ": " + name;
}

void check_blobs(const std::vector<Blob>& blobs) {
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    const Blob& blob = blobs[i];
    const auto name = [&](const char* field) { return member("blob", i, field); };
    require_in_range(name("x_m"), blob.x_m, -max_coordinate_m, max_coordinate_m);
    require_in_range(name("y_m"), blob.y_m, -max_coordinate_m, max_coordinate_m);
    require_in_range(name("radius_m"), blob.radius_m, 0.005, 20);
    require_in_range(name("depth_m"), blob.depth_m, -2, 2);
    if (blob.depth_m == 0) fail(name("depth_m"), " is 0; it must be above 0 for a pothole or below 0 for a bump");
    require_in_range(name("irregularity"), blob.irregularity, 0, 0.5);
    require_in_range(name("wall_share"), blob.wall_share, 0.02, 1);
  }
}

void check_cracks(const std::vector<Crack>& cracks) {
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    const Crack& crack = cracks[i];
    const auto name = [&](const char* field) { return member("crack", i, field); };
    if (crack.points_m.size() < 2) {
      fail(name("points_m"), " has ", crack.points_m.size(), " points; it must have at least 2");
    }
    for (const auto& point : crack.points_m) {
      require_in_range(name("points_m"), point[0], -max_coordinate_m, max_coordinate_m);
      require_in_range(name("points_m"), point[1], -max_coordinate_m, max_coordinate_m);
    }
    for (std::size_t k = 1; k < crack.points_m.size(); ++k) {
      const auto& a = crack.points_m[k - 1];
      const auto& b = crack.points_m[k];
      if (std::hypot(b[0] - a[0], b[1] - a[1]) < 1e-6) {
        fail(name("points_m"), " has the points ", k, " and ", k + 1, " at the same position; they must differ");
      }
    }
    require_in_range(name("width_m"), crack.width_m, 0.0005, 1);
    require_in_range(name("depth_m"), crack.depth_m, 0.0001, 1);
    require_in_range(name("irregularity"), crack.irregularity, 0, 0.9);
  }
}

void check_ruts(const std::vector<Rut>& ruts) {
  for (std::size_t i = 0; i < ruts.size(); ++i) {
    const Rut& rut = ruts[i];
    const auto name = [&](const char* field) { return member("rut", i, field); };
    for (const double value : {rut.from_m[0], rut.from_m[1]}) {
      require_in_range(name("from_m"), value, -max_coordinate_m, max_coordinate_m);
    }
    for (const double value : {rut.to_m[0], rut.to_m[1]}) {
      require_in_range(name("to_m"), value, -max_coordinate_m, max_coordinate_m);
    }
    require_in_range(name("width_m"), rut.width_m, 0.05, 5);
    require_in_range(name("depth_m"), rut.depth_m, 0.0001, 1);
    const double length_m = std::hypot(rut.to_m[0] - rut.from_m[0], rut.to_m[1] - rut.from_m[1]);
    if (length_m >= rut.width_m) continue;
    fail(name("to_m"), " is ", length_m, " m from from_m; it must be at least width_m, ", rut.width_m, " m, from it");
  }
}

void check_kerbs(const std::vector<Kerb>& kerbs) {
  for (std::size_t i = 0; i < kerbs.size(); ++i) {
    require_in_range(member("kerb", i, "x_m"), kerbs[i].x_m, -max_coordinate_m, max_coordinate_m);
    require_in_range(member("kerb", i, "height_m"), kerbs[i].height_m, -1, 1);
    require_in_range(member("kerb", i, "width_m"), kerbs[i].width_m, 0.001, 10);
  }
}

void check_boxes(const std::vector<Box>& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    const auto name = [&](const char* field) { return member("box", i, field); };
    require_in_range(name("x_m"), box.x_m, -max_coordinate_m, max_coordinate_m);
    require_in_range(name("y_m"), box.y_m, -max_coordinate_m, max_coordinate_m);
    require_in_range(name("width_m"), box.width_m, 0.01, 1000);
    require_in_range(name("length_m"), box.length_m, 0.01, 1000);
    require_in_range(name("bottom_m"), box.bottom_m, -100, 100);
    require_in_range(name("top_m"), box.top_m, box.bottom_m, 100);
    require_in_range(name("grey"), box.grey, 0, 1000);
    require_in_range(name("texture_contrast"), box.texture_contrast, 0, 4);
    require_in_range(name("panel_m"), box.panel_m, 0, 100);
  }
}

void check_road(const Road& road) {
  require_in_range("camber", road.camber, -0.1, 0.1);
  require_in_range("crest", road.crest, -0.1, 0.1);
  require_in_range("paint_grey", road.paint_grey, 0, 1000);
  require_in_range("shade", road.shade, 0, 0.95);
  require_in_range("wet_share", road.wet_share, 0, 1);
  require_in_range("verge_left_m", road.verge_left_m, -max_coordinate_m, max_coordinate_m);
  require_in_range("verge_right_m", road.verge_right_m, -max_coordinate_m, max_coordinate_m);
  require_in_range("texture_contrast", road.texture_contrast, 0, 4);
  check_blobs(road.blobs);
  check_cracks(road.cracks);
  check_ruts(road.ruts);
  check_kerbs(road.kerbs);
  check_boxes(road.boxes);
  constexpr std::size_t max_damages = std::numeric_limits<std::uint16_t>::max();
  const std::size_t damages = road.blobs.size() + road.cracks.size() + road.ruts.size();
  if (damages > max_damages) fail("the road has ", damages, " damages; it must have at most ", max_damages);
}

void check_degradation(const Degradation& degradation) {
  require_in_range("noise_grey", degradation.noise_grey, 0, 100);
  require_in_range("blur_px", degradation.blur_px, 0, 50);
  require_in_range("motion_blur_px", degradation.motion_blur_px, 0, 200);
  require_in_range("motion_blur_angle_deg", degradation.motion_blur_angle_deg, -360, 360);
  require_in_range("gain_difference", degradation.gain_difference, -0.95, 10);
  require_in_range("exposure", degradation.exposure, 0.01, 100);
  require_in_range("row_offset_px", degradation.row_offset_px, -100, 100);
  require_in_range("row_rotation_deg", degradation.row_rotation_deg, -10, 10);
  require_in_range("full_well_electrons", degradation.full_well_electrons, 0, 1e6);
  require_in_range("snowflakes", degradation.snowflakes, 0, 100000);
  require_in_range("bonnet_share", degradation.bonnet_share, 0, 0.9);
  require_in_range("jpeg_quality", degradation.jpeg_quality, 0, 100);
}

void check_shutter(const ShutterMotion& shutter) {
  constexpr double max_m = 100, max_deg = 45;
  require_in_range("shutter: x_m", shutter.x_m, -max_m, max_m);
  require_in_range("shutter: y_m", shutter.y_m, -max_m, max_m);
  require_in_range("shutter: height_m", shutter.height_m, -max_m, max_m);
  require_in_range("shutter: pitch_deg", shutter.pitch_deg, -max_deg, max_deg);
  require_in_range("shutter: roll_deg", shutter.roll_deg, -max_deg, max_deg);
  require_in_range("shutter: yaw_deg", shutter.yaw_deg, -max_deg, max_deg);
}

/// Throws Error if a camera is below the surface or less than 2 cm above it.
void check_clearance(const Rig& rig, const Road& road) {
  constexpr double min_clearance_m = 0.02;
  const HeightField field(road);
  for (const Camera& camera : {left_camera(rig), right_camera(rig)}) {
    const auto [x, y, z] = camera.origin;
    double surface = std::max(field.undamaged(x, y), field.height(x, y));
    for (const Box& box : road.boxes) {
      const AxisAlignedBox bounds = bounds_of(box);
      const bool is_above = x >= bounds.lower.x && x <= bounds.upper.x && y >= bounds.lower.y && y <= bounds.upper.y;
      if (is_above) surface = std::max(surface, bounds.upper.z);
    }
    if (z - surface < min_clearance_m) {
      fail("camera_height_m is ", rig.camera_height_m, ": a camera is ", z - surface,
           " m above the surface below it; it must be at least ", min_clearance_m, " m");
    }
  }
}

}  // namespace

void Rig::validate() const {
  require_in_range("width", width, min_image_side, max_image_side);
  require_in_range("height", height, min_image_side, max_image_side);
  require_in_range("focal_px", focal_px, 0.2 * width, 50.0 * width);
  require_in_range("baseline_m", baseline_m, 0.005, 10);
  require_in_range("camera_height_m", camera_height_m, 0.05, 500);
  require_in_range("pitch_deg", pitch_deg, 0, 90);
  require_in_range("roll_deg", roll_deg, -60, 60);
  require_in_range("yaw_deg", yaw_deg, -360, 360);
  require_in_range("x_m", x_m, -max_coordinate_m, max_coordinate_m);
  require_in_range("y_m", y_m, -max_coordinate_m, max_coordinate_m);
}

void Scene::validate() const {
  rig.validate();
  check_road(road);
  check_degradation(degradation);
  require_in_range("supersampling", supersampling, 1, 8);
  check_shutter(shutter);
  for (const int row : {0, rig.height - 1}) check_clearance(rig_of_row(*this, row), road);
}

}  // namespace roadstereo::synth

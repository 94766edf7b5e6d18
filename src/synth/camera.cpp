#include "synth/camera.hpp"

#include <cmath>
#include <numbers>

#include "core/degrees.hpp"

namespace roadstereo::synth {
namespace {

struct SineCosine {
  double sine;
  double cosine;
};

/// Sine and cosine of an angle, exact at 0° and 90°: a camera that looks straight down must see a plane at constant
/// depth, but cos(π/2) is not 0 in floating point.
SineCosine sine_cosine(double degrees) {
  const double radians = to_radians(degrees);
  if (degrees == 90) return {1, 0};
  if (degrees == 0) return {0, 1};
  return {std::sin(radians), std::cos(radians)};
}

}  // namespace

StereoCalibration Rig::calibration() const {
  StereoCalibration calibration;
  calibration.focal_px = focal_px;
  calibration.cx_px = (width - 1) / 2.0;
  calibration.cy_px = (height - 1) / 2.0;
  calibration.baseline_m = baseline_m;
  calibration.width = width;
  calibration.height = height;
  return calibration;
}

std::array<double, 12> Rig::camera_to_road() const {
  const Camera camera = left_camera(*this);
  const Vec3 &x = camera.right, &y = camera.down, &z = camera.forward, &origin = camera.origin;
  return {x.x, y.x, z.x, origin.x, x.y, y.y, z.y, origin.y, x.z, y.z, z.z, origin.z};
}

Rig rig_of_row(const Scene& scene, int row) {
  const ShutterMotion& motion = scene.shutter;
  Rig rig = scene.rig;
  const double share = 1.0 * row / (rig.height - 1) - 0.5;
  rig.x_m += share * motion.x_m;
  rig.y_m += share * motion.y_m;
  rig.camera_height_m += share * motion.height_m;
  rig.pitch_deg += share * motion.pitch_deg;
  rig.roll_deg += share * motion.roll_deg;
  rig.yaw_deg += share * motion.yaw_deg;
  return rig;
}

Camera left_camera(const Rig& rig) {
  const SineCosine pitch = sine_cosine(rig.pitch_deg);
  const SineCosine roll = sine_cosine(rig.roll_deg);
  const SineCosine yaw = sine_cosine(rig.yaw_deg);
  const auto turned = [&](double right, double ahead, double up) {
    return Vec3{yaw.cosine * right - yaw.sine * ahead, yaw.sine * right + yaw.cosine * ahead, up};
  };
  const Vec3 level_right = turned(1, 0, 0);
  const Vec3 level_down = turned(0, -pitch.sine, -pitch.cosine);
  Camera camera;
  camera.origin = {rig.x_m, rig.y_m, rig.camera_height_m};
  camera.right = level_right * roll.cosine + level_down * -roll.sine;
  camera.down = level_right * roll.sine + level_down * roll.cosine;
  camera.forward = turned(0, pitch.cosine, -pitch.sine);
  camera.focal_px = rig.focal_px;
  camera.cx_px = (rig.width - 1) / 2.0;
  camera.cy_px = (rig.height - 1) / 2.0;
  return camera;
}

Camera right_camera(const Rig& rig, const Degradation& degradation) {
  Camera camera = left_camera(rig);
  camera.origin = camera.origin + camera.right * rig.baseline_m;
  camera.cy_px += degradation.row_offset_px;
  const SineCosine turn = sine_cosine(degradation.row_rotation_deg);
  const Vec3 right = camera.right;
  camera.right = right * turn.cosine + camera.down * -turn.sine;
  camera.down = right * turn.sine + camera.down * turn.cosine;
  return camera;
}

DisparityPlane road_disparity_plane(const Rig& rig) {
  // A ray meets Z = 0 at depth −height / direction.z, and direction.z is affine in (u, v).
  const Camera camera = left_camera(rig);
  const double scale = -rig.baseline_m / rig.camera_height_m;
  DisparityPlane plane;
  plane.a1 = scale * camera.down.z;
  plane.a2 = scale * camera.right.z;
  plane.a0 = scale * rig.focal_px * camera.forward.z - plane.a1 * camera.cy_px - plane.a2 * camera.cx_px;
  return plane;
}

double roll_angle(const DisparityPlane& plane) {
  if (plane.a1 == 0) return plane.a2 == 0 ? 0.0 : std::numbers::pi / 2;
  return std::atan(-plane.a2 / plane.a1);
}

FootprintModel::FootprintModel(const Camera& camera, double midpoint_offset_m)
    : camera_(camera), midpoint_offset_m_(midpoint_offset_m) {
  const double height = camera.origin.z + camera.right.z * midpoint_offset_m;
  inverse_depth_per_column_ = -camera.right.z / (height * camera.focal_px);
  inverse_depth_per_row_ = -camera.down.z / (height * camera.focal_px);
}

Footprint FootprintModel::at(double depth, double u, double v) const {
  // The point is C + Z·D; its derivative is Z·D' − Z²·(1/Z)'·D. The lateral component of D is reduced to a third: the
  // rays of a pixel average over it already, and the full component would blur distant texture at the sides.
  const double column = (u - camera_.cx_px) / camera_.focal_px - midpoint_offset_m_ / depth;
  const double row = (v - camera_.cy_px) / camera_.focal_px;
  const Vec3 sight = camera_.forward + camera_.down * row + camera_.right * (column / 3);
  const double across = depth / camera_.focal_px;
  const Vec3 per_column = camera_.right * across + sight * (-depth * depth * inverse_depth_per_column_);
  const Vec3 per_row = camera_.down * across + sight * (-depth * depth * inverse_depth_per_row_);
  return {std::sqrt(per_column.x * per_column.x + per_row.x * per_row.x),
          std::sqrt(per_column.y * per_column.y + per_row.y * per_row.y)};
}

}  // namespace roadstereo::synth

#include "odometry/alignment_equations.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/direct_alignment.hpp"

namespace roadstereo {
namespace {

constexpr double min_depth_m = 0.05;

/// Grey level and its gradient between pixels: 8-bit grey levels, and per pixel of the level.
struct GreySample {
  float grey = 0;
  float per_column = 0;
  float per_row = 0;
};

/// Bilinear, of central differences; false outside.
bool sample_grey(ImageView<const std::int16_t> level, double x, double y, GreySample& sample) {
  constexpr int margin = 1;
  if (!(x >= margin && y >= margin && x < level.width() - 1 - margin && y < level.height() - 1 - margin)) return false;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const float fu = static_cast<float>(x - u), fv = static_cast<float>(y - v);
  const std::int16_t* above = level.row(v - 1) + u;
  const std::int16_t* a = level.row(v) + u;
  const std::int16_t* b = level.row(v + 1) + u;
  const std::int16_t* below = level.row(v + 2) + u;
  const auto between = [fu, fv](int a0, int a1, int b0, int b1) {
    return (1 - fu) * (1 - fv) * static_cast<float>(a0) + fu * (1 - fv) * static_cast<float>(a1) +
           (1 - fu) * fv * static_cast<float>(b0) + fu * fv * static_cast<float>(b1);
  };
  sample.grey = between(a[0], a[1], b[0], b[1]) * grey_unit;
  sample.per_column = between(a[1] - a[-1], a[2] - a[0], b[1] - b[-1], b[2] - b[0]) * (grey_unit / 2);
  sample.per_row = between(b[0] - above[0], b[1] - above[1], below[0] - a[0], below[1] - a[1]) * (grey_unit / 2);
  return true;
}

/// Velocity of points at the end of a motion that was a constant one, per duration of the motion.
class EndVelocity {
 public:
  explicit EndVelocity(const RigidMotion& motion) {
    const Twist twist = twist_of(motion);
    turn_ = {twist[3], twist[4], twist[5]};
    const Vector<3>&t = motion.translation, bend = cross(turn_, t);
    for (std::size_t i = 0; i < 3; ++i) shift_[i] = t[i] - bend[i] / 2;
  }

  Vector<3> operator()(const Vector<3>& q) const {
    const Vector<3> turned = cross(turn_, q);
    return {shift_[0] + turned[0], shift_[1] + turned[1], shift_[2] + turned[2]};
  }

 private:
  Vector<3> turn_{}, shift_{};
};

/// Point of the reference at the present motion.
struct MovedPoint {
  Vector<3> q{};        ///< in the current camera frame, metres
  double u = 0, v = 0;  ///< its pixel
  double disparity = 0, shape = 0;
  Vector<3> by_disparity{}, by_shutter{};  ///< derivatives of q
};

class Linearisation {
 public:
  Linearisation(const FrameMaps& current, const StereoCalibration& calibration, int level)
      : current_(current),
        calibration_(calibration),
        grey_(current.pyramid.level(level)),
        scale_(1.0 / (1 << level)),
        depth_scale_(calibration.focal_px * calibration.baseline_m),
        rows_(current.disparity.height() - 1) {}

  void build(const std::vector<ReferencePoint>& points, const AlignmentState& state,
             AlignmentEquations& equations) const {
    equations.grey.clear();
    equations.disparity.clear();
    equations.visible = 0;
    const EndVelocity velocity(state.motion);
    for (const ReferencePoint& point : points) add(point, state, velocity, equations);
  }

 private:
  void add(const ReferencePoint& point, const AlignmentState& state, const EndVelocity& velocity,
           AlignmentEquations& equations) const {
    const double shape = offset_shape(calibration_, point.u, point.disparity);
    const double disparity = point.disparity + state.offset(shape) + calibration_.disparity_offset_px;
    if (!(disparity > 0)) return;
    const double f = calibration_.focal_px;
    const double z = depth_scale_ / disparity;
    const Vector<3> p{(point.u - calibration_.cx_px) / f * z, (point.v - calibration_.cy_px) / f * z, z};
    const Vector<3> turned = state.motion.rotated(p);
    Vector<3> q = turned;
    for (std::size_t i = 0; i < 3; ++i) q[i] += state.motion.translation[i];
    Vector<3> by_shutter{};
    if (!end_of_motion(state.shutter, point.v, velocity, q, by_shutter)) return;
    const double pixels_per_m = f / q[2];
    const double u = pixels_per_m * q[0] + calibration_.cx_px, v = pixels_per_m * q[1] + calibration_.cy_px;
    GreySample sample;
    if (!sample_grey(grey_, (u + 0.5) * scale_ - 0.5, (v + 0.5) * scale_ - 0.5, sample)) return;
    const double scale = z / q[2];
    equations.visible += std::min(1.0, scale * scale);
    // Derivative of q by the disparity.
    const double nearer = -1 / disparity;
    const Vector<3> by_disparity{nearer * turned[0], nearer * turned[1], nearer * turned[2]};
    // Derivative of the grey level by q.
    const double gu = sample.per_column * scale_ * pixels_per_m, gv = sample.per_row * scale_ * pixels_per_m;
    const Vector<3> by_q{gu, gv, -(gu * q[0] + gv * q[1]) / q[2]};
    AlignmentEquation& equation = equations.grey.emplace_back();
    equation.cell = point.cell;
    equation.residual = sample.grey - state.gain * point.grey - state.brightness;
    put_motion(by_q, q, equation);
    equation.row[shutter_index] = dot(by_q, by_shutter);
    equation.row[gain_index] = -point.grey;
    equation.row[brightness_index] = -1;
    const double by_offset = dot(by_q, by_disparity);
    equation.row[offset_index] = by_offset * shape;
    equation.row[growth_index] = by_offset * (shape - 1);
    equation.variance = by_offset * by_offset * point.sigma_px * point.sigma_px;
    add_disparity(point, state, {q, u, v, disparity, shape, by_disparity, by_shutter}, equations);
  }

  /// Moves a point on to when its row of the current frame is exposed, by the shutter; `by_shutter`: derivative. False
  /// behind the camera.
  bool end_of_motion(double shutter, double reference_row, const EndVelocity& velocity, Vector<3>& q,
                     Vector<3>& by_shutter) const {
    const Vector<3> start = q;
    const int passes = shutter != 0 ? 3 : 1;  // the row depends on the time, little
    for (int i = 0; i < passes; ++i) {
      if (!(q[2] > min_depth_m)) return false;
      const Vector<3> speed = velocity(q);
      const double row = calibration_.focal_px * q[1] / q[2] + calibration_.cy_px;
      const double later = (row - reference_row) / rows_;
      for (std::size_t k = 0; k < 3; ++k) {
        by_shutter[k] = later * speed[k];
        q[k] = start[k] + shutter * by_shutter[k];
      }
    }
    return q[2] > min_depth_m;
  }

  /// The measured disparity where a point is seen against that of the point, point to plane.
  void add_disparity(const ReferencePoint& point, const AlignmentState& state, const MovedPoint& moved,
                     AlignmentEquations& equations) const {
    SurfaceSample surface;
    if (!sample_surface(current_, moved.u, moved.v, surface)) return;
    const double f = calibration_.focal_px;
    const Vector<3>& q = moved.q;
    // N·p = b for points of the plane around the point of the reference.
    const Vector<3> plane{point.slope_u, point.slope_v,
                          (moved.disparity - point.slope_u * (point.u - calibration_.cx_px) -
                           point.slope_v * (point.v - calibration_.cy_px)) /
                              f};
    const Vector<3> normal = state.motion.rotated(plane);
    const double towards = dot(normal, q);
    if (!(towards > 0)) return;
    const double here = offset_shape(calibration_, moved.u, surface.disparity);
    const double factor = depth_scale_ / (q[2] * towards);
    const Vector<3> by_q{factor * normal[0], factor * normal[1], factor * normal[2]};
    AlignmentEquation& equation = equations.disparity.emplace_back();
    equation.cell = point.cell;
    equation.residual = surface.disparity + state.offset(here) + calibration_.disparity_offset_px - depth_scale_ / q[2];
    put_motion(by_q, q, equation);
    equation.row[shutter_index] = dot(by_q, moved.by_shutter);
    const double by_offset = dot(by_q, moved.by_disparity);
    equation.row[offset_index] = here + by_offset * moved.shape;
    equation.row[growth_index] = here - 1 + by_offset * (moved.shape - 1);
    equation.variance = surface.sigma_px * surface.sigma_px + by_offset * by_offset * point.sigma_px * point.sigma_px;
  }

  /// Derivatives by a translation and a rotation of q.
  static void put_motion(const Vector<3>& by_q, const Vector<3>& q, AlignmentEquation& equation) {
    const Vector<3> by_rotation = cross(q, by_q);
    for (std::size_t i = 0; i < 3; ++i) {
      equation.row[i] = by_q[i];
      equation.row[i + 3] = by_rotation[i];
    }
  }

  const FrameMaps& current_;
  const StereoCalibration& calibration_;
  ImageView<const std::int16_t> grey_;
  double scale_;
  double depth_scale_;
  double rows_;  ///< from the first to the last
};

}  // namespace

void linearise(const std::vector<ReferencePoint>& points, const FrameMaps& current,
               const StereoCalibration& calibration, int level, const AlignmentState& state,
               AlignmentEquations& equations) {
  Linearisation(current, calibration, level).build(points, state, equations);
}

}  // namespace roadstereo

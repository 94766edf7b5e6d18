#include "odometry/alignment_equations.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "odometry/alignment_equations.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int max_lanes = 8;
using Doubles = hn::CappedTag<double, max_lanes>;
using Double = hn::Vec<Doubles>;

HWY_INLINE Double all(double value) {
  return hn::Set(Doubles(), value);
}

/// Vectors of as many points as there are lanes.
struct Vectors {
  Double x, y, z;
};

HWY_INLINE Double dot(const Vectors& a, const Vectors& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Vectors plus(const Vectors& a, const Vectors& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vectors times(Double factor, const Vectors& a) {
  return {hn::Mul(factor, a.x), hn::Mul(factor, a.y), hn::Mul(factor, a.z)};
}

HWY_INLINE Vectors all(const Vector<3>& a) {
  return {all(a[0]), all(a[1]), all(a[2])};
}

HWY_INLINE Vectors rotated(const RigidMotion& motion, const Vectors& a) {
  return {dot(all(motion.rotation[0]), a), dot(all(motion.rotation[1]), a), dot(all(motion.rotation[2]), a)};
}

/// One number of every point of a batch.
struct Numbers {
  HWY_ALIGN double at[max_lanes] = {};

  Double load() const { return hn::Load(Doubles(), at); }
  void store(Double values) { hn::Store(values, Doubles(), at); }
};

/// Points of the reference, and what the current frame shows of them.
struct Batch {
  int count = 0;
  Numbers u, v, disparity, sigma, grey, slope_u, slope_v;
  Numbers sample, per_column, per_row;  ///< grey level there, and its gradient
  Numbers surface_disparity, surface_sigma;
  bool has_sample[max_lanes] = {}, has_surface[max_lanes] = {};

  /// Lanes beyond `count` repeat the last point.
  void read(const ReferencePoint* points) {
    for (int i = 0; i < static_cast<int>(hn::Lanes(Doubles())); ++i) {
      const ReferencePoint& point = points[std::min(i, count - 1)];
      u.at[i] = point.u;
      v.at[i] = point.v;
      disparity.at[i] = point.disparity;
      sigma.at[i] = point.sigma_px;
      grey.at[i] = point.grey;
      slope_u.at[i] = point.slope_u;
      slope_v.at[i] = point.slope_v;
    }
  }

  /// Samples what the current frame has at the pixels (at_u, at_v) of the points that are in front of it.
  void look(const FrameMaps& current, ImageView<const std::int16_t> level, double scale, const Numbers& at_u,
            const Numbers& at_v, const bool* in_front) {
    for (int i = 0; i < count; ++i) {
      GreySample there;
      has_sample[i] =
          in_front[i] && sample_grey(level, (at_u.at[i] + 0.5) * scale - 0.5, (at_v.at[i] + 0.5) * scale - 0.5, there);
      sample.at[i] = static_cast<double>(there.grey);
      per_column.at[i] = static_cast<double>(there.per_column);
      per_row.at[i] = static_cast<double>(there.per_row);
      SurfaceSample surface;
      has_surface[i] = has_sample[i] && sample_surface(current, at_u.at[i], at_v.at[i], surface);
      surface_disparity.at[i] = surface.disparity;
      surface_sigma.at[i] = surface.sigma_px;
    }
  }
};

/// One equation of every point of a batch.
struct EquationBatch {
  std::array<Numbers, unknowns> row;
  Numbers residual, variance;

  /// Derivatives by a translation and a rotation of q.
  HWY_INLINE void put_motion(const Vectors& by_q, const Vectors& q) {
    const Vectors by_rotation = cross(q, by_q);
    row[0].store(by_q.x);
    row[1].store(by_q.y);
    row[2].store(by_q.z);
    row[3].store(by_rotation.x);
    row[4].store(by_rotation.y);
    row[5].store(by_rotation.z);
  }

  void append(int lane, int cell, ScratchVector<AlignmentEquation>& equations) const {
    AlignmentEquation& equation = equations.emplace_back();
    for (std::size_t i = 0; i < unknowns; ++i) equation.row[i] = row[i].at[lane];
    equation.residual = residual.at[lane];
    equation.variance = variance.at[lane];
    equation.cell = cell;
  }
};

/// Points of the reference at the present motion.
struct MovedPoints {
  Vectors q;    ///< in the current camera frame, metres
  Double u, v;  ///< their pixels
  Double pixels_per_m;
  Double z;  ///< of the reference, metres
  Double disparity, shape;
  Vectors by_disparity, by_shutter;  ///< derivatives of q
};

class Linearisation {
 public:
  Linearisation(const FrameMaps& current, const StereoCalibration& calibration, int level, const AlignmentState& state)
      : current_(current),
        calibration_(calibration),
        state_(state),
        grey_(current.pyramid.level(level)),
        scale_(1.0 / (1 << level)),
        focal_(all(calibration.focal_px)),
        depth_scale_(all(calibration.focal_px * calibration.baseline_m)) {
    // Velocity of points at the end of a motion that was a constant one, per duration of the motion: shift + turn × q.
    const Twist twist = twist_of(state.motion);
    const Vector<3> turn{twist[3], twist[4], twist[5]}, bend = roadstereo::cross(turn, state.motion.translation);
    Vector<3> shift = state.motion.translation;
    for (std::size_t i = 0; i < 3; ++i) shift[i] -= bend[i] / 2;
    turn_ = all(turn);
    shift_ = all(shift);
  }

  void add(const ReferencePoint* points, int count, AlignmentEquations& equations) {
    batch_.count = count;
    batch_.read(points);
    bool in_front[max_lanes];
    const MovedPoints moved = move(in_front);
    Numbers u, v;
    u.store(moved.u);
    v.store(moved.v);
    batch_.look(current_, grey_, scale_, u, v, in_front);
    compare_grey_levels(moved);
    compare_disparities(moved);
    Numbers scale;
    scale.store(hn::Div(moved.z, moved.q.z));
    for (int i = 0; i < count; ++i) {
      if (!batch_.has_sample[i]) continue;
      equations.visible += std::min(1.0, scale.at[i] * scale.at[i]);
      grey_equations_.append(i, points[i].cell, equations.grey);
      if (has_plane_[i]) disparity_equations_.append(i, points[i].cell, equations.disparity);
    }
  }

 private:
  /// `offset_shape` (direct_alignment.hpp) of the points.
  HWY_INLINE Double shape_of_offset(Double u, Double disparity) const {
    const Double x = hn::Div(hn::Sub(hn::Sub(u, disparity), all(calibration_.cx_px)), focal_);
    return hn::MulAdd(x, x, all(1));
  }

  /// Offset of the disparity where the shape of an offset has a value, that of the calibration included.
  HWY_INLINE Double offset(Double shape) const {
    return hn::MulAdd(all(state_.offset_px), shape,
                      hn::MulAdd(all(state_.growth_px), hn::Sub(shape, all(1)), all(calibration_.disparity_offset_px)));
  }

  HWY_INLINE MovedPoints move(bool* in_front) const {
    constexpr double min_depth_m = 0.05;
    MovedPoints moved;
    const Double u = batch_.u.load(), v = batch_.v.load(), measured = batch_.disparity.load();
    moved.shape = shape_of_offset(u, measured);
    moved.disparity = hn::Add(measured, offset(moved.shape));
    auto valid = hn::Gt(moved.disparity, all(0));
    moved.z = hn::Div(depth_scale_, moved.disparity);
    const Double per_focal = hn::Div(moved.z, focal_);
    const Vectors p{hn::Mul(hn::Sub(u, all(calibration_.cx_px)), per_focal),
                    hn::Mul(hn::Sub(v, all(calibration_.cy_px)), per_focal), moved.z};
    const Vectors turned = rotated(state_.motion, p), start = plus(turned, all(state_.motion.translation));
    moved.by_disparity = times(hn::Div(all(-1), moved.disparity), turned);
    // The shutter: each point moves on until its row of the current frame is exposed.
    moved.q = start;
    const int passes = state_.shutter != 0 ? 3 : 1;  // the row depends on the time, little
    const Double rows = all(current_.disparity.height() - 1);
    for (int i = 0; i < passes; ++i) {
      valid = hn::And(valid, hn::Gt(moved.q.z, all(min_depth_m)));
      const Double row = hn::Add(hn::Div(hn::Mul(focal_, moved.q.y), moved.q.z), all(calibration_.cy_px));
      const Vectors speed = plus(shift_, cross(turn_, moved.q));
      moved.by_shutter = times(hn::Div(hn::Sub(row, v), rows), speed);
      moved.q = plus(start, times(all(state_.shutter), moved.by_shutter));
    }
    valid = hn::And(valid, hn::Gt(moved.q.z, all(min_depth_m)));
    moved.pixels_per_m = hn::Div(focal_, moved.q.z);
    moved.u = hn::MulAdd(moved.pixels_per_m, moved.q.x, all(calibration_.cx_px));
    moved.v = hn::MulAdd(moved.pixels_per_m, moved.q.y, all(calibration_.cy_px));
    write(valid, in_front);
    return moved;
  }

  HWY_INLINE static void write(hn::Mask<Doubles> mask, bool* flags) {
    Numbers ones;
    ones.store(hn::IfThenElseZero(mask, all(1)));
    for (int i = 0; i < max_lanes; ++i) flags[i] = ones.at[i] != 0;
  }

  HWY_INLINE void compare_grey_levels(const MovedPoints& moved) {
    const Vectors& q = moved.q;
    const Double scale = hn::Mul(all(scale_), moved.pixels_per_m), grey = batch_.grey.load();
    const Double gu = hn::Mul(batch_.per_column.load(), scale), gv = hn::Mul(batch_.per_row.load(), scale);
    const Vectors by_q{gu, gv, hn::Div(hn::Neg(hn::MulAdd(gu, q.x, hn::Mul(gv, q.y))), q.z)};
    EquationBatch& equation = grey_equations_;
    equation.residual.store(
        hn::Sub(hn::Sub(batch_.sample.load(), hn::Mul(all(state_.gain), grey)), all(state_.brightness)));
    equation.put_motion(by_q, q);
    equation.row[shutter_index].store(dot(by_q, moved.by_shutter));
    equation.row[gain_index].store(hn::Neg(grey));
    equation.row[brightness_index].store(all(-1));
    const Double by_offset = dot(by_q, moved.by_disparity);
    equation.row[offset_index].store(hn::Mul(by_offset, moved.shape));
    equation.row[growth_index].store(hn::Mul(by_offset, hn::Sub(moved.shape, all(1))));
    const Double error = hn::Mul(by_offset, batch_.sigma.load());
    equation.variance.store(hn::Mul(error, error));
  }

  /// The measured disparity where a point is seen against that of the point, point to plane.
  HWY_INLINE void compare_disparities(const MovedPoints& moved) {
    const Vectors& q = moved.q;
    // N·p = b for points of the plane around the point of the reference.
    const Double slope_u = batch_.slope_u.load(), slope_v = batch_.slope_v.load();
    const Double along = hn::MulAdd(slope_u, hn::Sub(batch_.u.load(), all(calibration_.cx_px)),
                                    hn::Mul(slope_v, hn::Sub(batch_.v.load(), all(calibration_.cy_px))));
    const Vectors normal = rotated(state_.motion, {slope_u, slope_v, hn::Div(hn::Sub(moved.disparity, along), focal_)});
    const Double towards = dot(normal, q), surface = batch_.surface_disparity.load();
    write(hn::Gt(towards, all(0)), has_plane_);
    for (int i = 0; i < max_lanes; ++i) has_plane_[i] = has_plane_[i] && batch_.has_surface[i];
    const Double here = shape_of_offset(moved.u, surface), predicted = hn::Div(depth_scale_, q.z);
    const Vectors by_q = times(hn::Div(predicted, towards), normal);
    EquationBatch& equation = disparity_equations_;
    equation.residual.store(hn::Sub(hn::Add(surface, offset(here)), predicted));
    equation.put_motion(by_q, q);
    equation.row[shutter_index].store(dot(by_q, moved.by_shutter));
    const Double by_offset = dot(by_q, moved.by_disparity);
    equation.row[offset_index].store(hn::MulAdd(by_offset, moved.shape, here));
    equation.row[growth_index].store(hn::MulAdd(by_offset, hn::Sub(moved.shape, all(1)), hn::Sub(here, all(1))));
    const Double error = hn::Mul(by_offset, batch_.sigma.load()), own = batch_.surface_sigma.load();
    equation.variance.store(hn::MulAdd(own, own, hn::Mul(error, error)));
  }

  const FrameMaps& current_;
  const StereoCalibration& calibration_;
  const AlignmentState& state_;
  ImageView<const std::int16_t> grey_;
  double scale_;
  Double focal_, depth_scale_;
  Vectors turn_, shift_;
  Batch batch_;
  EquationBatch grey_equations_, disparity_equations_;
  bool has_plane_[max_lanes] = {};
};

void linearise_level(const std::vector<ReferencePoint>& points, const FrameMaps& current,
                     const StereoCalibration& calibration, int level, const AlignmentState& state,
                     AlignmentEquations& equations) {
  equations.grey.clear();
  equations.disparity.clear();
  equations.grey.reserve(points.size());
  equations.disparity.reserve(points.size());
  equations.visible = 0;
  const std::size_t lanes = hn::Lanes(Doubles());
  Linearisation linearisation(current, calibration, level, state);
  for (std::size_t first = 0; first < points.size(); first += lanes) {
    linearisation.add(points.data() + first, static_cast<int>(std::min(lanes, points.size() - first)), equations);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(linearise_level);

void linearise(const std::vector<ReferencePoint>& points, const FrameMaps& current,
               const StereoCalibration& calibration, int level, const AlignmentState& state,
               AlignmentEquations& equations) {
  HWY_DYNAMIC_DISPATCH(linearise_level)(points, current, calibration, level, state, equations);
}

}  // namespace roadstereo
#endif

// Points of a reference, as many as a vector has lanes, and what the current frame shows of them.

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "odometry/reference_points.hpp"
#include "odometry/rigid_motion.hpp"

#if defined(ROADSTEREO_ODOMETRY_POINT_LANES_INL) == defined(HWY_TARGET_TOGGLE)  // once for every instruction set
#ifdef ROADSTEREO_ODOMETRY_POINT_LANES_INL
#undef ROADSTEREO_ODOMETRY_POINT_LANES_INL
#else
#define ROADSTEREO_ODOMETRY_POINT_LANES_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int max_lanes = 8;
using Doubles = hn::CappedTag<double, max_lanes>;
using Double = hn::Vec<Doubles>;

HWY_INLINE Double all(double value) {
  return hn::Set(Doubles(), value);
}

// Structures of vectors are only ever initialised whole: GCC compiles implicit constructors without the attributes of
// the instruction set, and refuses to for NEON.

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
  Numbers u, v, disparity, sigma, grey, slope_u, slope_v;
  Numbers sample, per_column, per_row;  ///< grey level there, and its gradient
  Numbers has_sample;                   ///< 0 or 1

  /// Points from `first` on; lanes beyond the last point repeat it.
  void read(const std::vector<ReferencePoint>& points, std::size_t first) {
    for (std::size_t i = 0; i < hn::Lanes(Doubles()); ++i) {
      const ReferencePoint& point = points[std::min(first + i, points.size() - 1)];
      u.at[i] = point.u;
      v.at[i] = point.v;
      disparity.at[i] = point.disparity;
      sigma.at[i] = point.sigma_px;
      grey.at[i] = point.grey;
      slope_u.at[i] = point.slope_u;
      slope_v.at[i] = point.slope_v;
    }
  }

  /// Samples the grey levels at the pixels (at_u, at_v) of the points that are in front of the camera.
  void look(ImageView<const std::int16_t> level, double scale, const Numbers& at_u, const Numbers& at_v,
            const Numbers& in_front) {
    for (std::size_t i = 0; i < hn::Lanes(Doubles()); ++i) {
      GreySample there;
      const bool seen = in_front.at[i] != 0 &&
                        sample_grey(level, (at_u.at[i] + 0.5) * scale - 0.5, (at_v.at[i] + 0.5) * scale - 0.5, there);
      has_sample.at[i] = seen ? 1 : 0;
      sample.at[i] = static_cast<double>(there.grey);
      per_column.at[i] = static_cast<double>(there.per_column);
      per_row.at[i] = static_cast<double>(there.per_row);
    }
  }
};

/// Disparities between pixels and their standard errors.
struct Surface {
  Double disparity, sigma;
  hn::Mask<Doubles> valid;
};

/// Bilinear, of maps of 2×2 pixels at least; valid where the pixels around are of one surface.
HWY_INLINE Surface sample_surface(ImageView<const float> disparity, ImageView<const float> sigma, Double u, Double v) {
  const Doubles d;
  const hn::Rebind<float, Doubles> df;
  const hn::Rebind<std::int32_t, Doubles> di;
  const auto inside = hn::And(hn::And(hn::Ge(u, all(0)), hn::Lt(u, all(disparity.width() - 1))),
                              hn::And(hn::Ge(v, all(0)), hn::Lt(v, all(disparity.height() - 1))));
  u = hn::IfThenElseZero(inside, u);
  v = hn::IfThenElseZero(inside, v);
  const auto x = hn::DemoteTo(di, u), y = hn::DemoteTo(di, v);
  const Double fu = hn::Sub(u, hn::PromoteTo(d, x)), fv = hn::Sub(v, hn::PromoteTo(d, y));
  const auto pitch = [&](ImageView<const float> map) { return hn::Set(di, static_cast<std::int32_t>(map.stride())); };
  const auto at = hn::Add(hn::Mul(y, pitch(disparity)), x);
  const auto pixel = [&](int du, int dv) { return hn::PromoteTo(d, hn::GatherIndex(df, disparity.row(dv) + du, at)); };
  const Double a = pixel(0, 0), b = pixel(1, 0), c = pixel(0, 1), e = pixel(1, 1);
  const auto between = [](Double share, Double first, Double second) {
    return hn::Add(hn::Mul(hn::Sub(all(1), share), first), hn::Mul(share, second));
  };
  const Double value = between(fv, between(fu, a, b), between(fu, c, e));
  const Double jump = hn::Sub(hn::Max(hn::Max(a, b), hn::Max(c, e)), hn::Min(hn::Min(a, b), hn::Min(c, e)));
  const auto nearest = [&](Double share, auto whole) {
    return hn::Add(whole, hn::DemoteTo(di, hn::IfThenElseZero(hn::Gt(share, all(0.5)), all(1))));
  };
  const auto nearest_at = hn::Add(hn::Mul(nearest(fv, y), pitch(sigma)), nearest(fu, x));
  const Double error = hn::PromoteTo(d, hn::GatherIndex(df, sigma.row(0), nearest_at));
  const auto valid = hn::And(hn::And(inside, hn::Eq(value, value)),  // not NaN
                             hn::And(hn::Lt(jump, all(max_jump_px)), hn::Gt(error, all(0))));
  return {value, error, valid};
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

#pragma once

#include <optional>
#include <span>

#include "core/scratch.hpp"
#include "road/least_quantile.hpp"
#include "road/raw_sums.hpp"
#include "road/robust_weights.hpp"
#include "roadstereo/road_model.hpp"

// Plane fits in disparity space: preemptive RANSAC or the least quantile of squares for a start, and IRLS with Tukey's
// biweight.

namespace roadstereo {

/// A point of disparity space: pixel (u, v) of the left image with disparity d.
struct DisparityPoint {
  double u = 0;
  double v = 0;
  double d = 0;
};

/// The ten sums over a disparity map that eqs. (21) and (23) are made of. Coordinates are taken relative to an
/// origin near the data, so that differences of large sums do not cancel.
class PlaneSums {
 public:
  explicit PlaneSums(double origin_u = 0, double origin_v = 0, const RawSums& sums = {})
      : origin_u_(origin_u), origin_v_(origin_v), s_(sums) {}

  void add(const DisparityPoint& point, double weight = 1) {
    const double u = point.u - origin_u_, v = point.v - origin_v_;
    s_.n += weight;
    s_.u += weight * u;
    s_.v += weight * v;
    s_.d += weight * point.d;
    s_.uu += weight * u * u;
    s_.uv += weight * u * v;
    s_.vv += weight * v * v;
    s_.ud += weight * u * point.d;
    s_.vd += weight * v * point.d;
    s_.dd += weight * point.d * point.d;
  }
  void add(const PlaneSums& other);

  DeviationSums deviations() const { return deviations_of(s_, origin_u_, origin_v_); }

  double weight() const { return s_.n; }
  double mean_u() const { return origin_u_ + s_.u / s_.n; }
  double mean_v() const { return origin_v_ + s_.v / s_.n; }
  double mean_d() const { return s_.d / s_.n; }

  /// Sums of products of deviations from the means.
  double uu() const { return s_.uu - s_.u * s_.u / s_.n; }
  double uv() const { return s_.uv - s_.u * s_.v / s_.n; }
  double vv() const { return s_.vv - s_.v * s_.v / s_.n; }
  double ud() const { return s_.ud - s_.u * s_.d / s_.n; }
  double vd() const { return s_.vd - s_.v * s_.d / s_.n; }
  double dd() const { return s_.dd - s_.d * s_.d / s_.n; }

  /// The least-squares plane; nothing when the points lie on one line of the image. `with_roll` false keeps a2 = 0.
  std::optional<DisparityPlane> plane(bool with_roll = true) const;

 private:
  double origin_u_, origin_v_;
  RawSums s_;
};

/// A plane through most of the points, and how well it fits those.
struct IrlsPlaneFit {
  DisparityPlane plane;
  double scale_px = 0;  ///< robust standard deviation of the inliers
  int iterations = 0;
  ScratchVector<double> weights = scratch_vector<double>();  ///< Tukey weights of the points, 0 … 1
};

/// Iteratively reweighted least squares with Tukey's biweight from a starting plane, down from a window of
/// `start_scale_px`. Nothing when too few points stay.
std::optional<IrlsPlaneFit> fit_plane_irls(std::span<const DisparityPoint> points, const DisparityPlane& start,
                                           double start_scale_px, bool with_roll, int max_iterations);

/// Preemptive RANSAC plane fit: the plane through three of the points that the others support most, each within
/// `tolerance_px` by 1 − (residual / tolerance)²: a start that no outliers pull. Deterministic. Nothing when no three
/// points span a plane.
std::optional<DisparityPlane> ransac_plane(std::span<const DisparityPoint> points, double tolerance_px);

/// Least quantile of squares: the best of `start` and of planes through three of the points. `d` is NaN where a point
/// is missing. Deterministic.
QuantilePlane least_quantile_plane(std::span<const DisparityPoint> points, const DisparityPlane& start);

/// The plane through three points; nothing when they lie on one line of the image.
std::optional<DisparityPlane> plane_through(const DisparityPoint& a, const DisparityPoint& b, const DisparityPoint& c);

}  // namespace roadstereo

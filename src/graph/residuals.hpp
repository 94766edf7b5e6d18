#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "graph/graph_pose.hpp"
#include "graph/track_observations.hpp"

namespace roadstereo {

/// A matrix W with WᵀW = C⁻¹.
template <int N>
Eigen::Matrix<double, N, N> whitening(const Eigen::Matrix<double, N, N>& covariance) {
  const Eigen::Matrix<double, N, N> factor = covariance.llt().matrixL();
  return factor.template triangularView<Eigen::Lower>().solve(Eigen::Matrix<double, N, N>::Identity());
}

/// Error of a relative pose in the axes of camera `to`, translation, then rotation vector, whitened.
class LinkResidual {
 public:
  LinkResidual(const GraphPose& motion, const Eigen::Matrix<double, 6, 6>& covariance)
      : motion_(motion), whitening_(whitening<6>(covariance)) {}

  template <class T>
  bool operator()(const T* from_position, const T* from_rotation, const T* to_position, const T* to_rotation,
                  T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const Vector> p(from_position), q(to_position);
    const Eigen::Map<const Rotation> a(from_rotation), b(to_rotation);
    const Rotation turn = b.conjugate() * a;  // from camera `from` to camera `to`
    const Vector shift = b.conjugate() * (p - q).eval();
    const Rotation error = motion_.rotation.template cast<T>() * turn.conjugate();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
    r.template head<3>() = motion_.position.template cast<T>() - error * shift;
    r.template tail<3>() = (error.w() < T(0) ? T(-2) : T(2)) * error.vec();
    r = whitening_.template cast<T>() * r;
    return true;
  }

 private:
  GraphPose motion_;
  Eigen::Matrix<double, 6, 6> whitening_;
};

/// Distance of the antenna from a position of the track, in standard errors. The time offset moves the antenna along
/// the odometry, whose speed is known to millimetres per second: that of a curve through noisy fixes would be no
/// evidence of their time.
class FixResidual {
 public:
  /// `shares` is how many times the common error of the fixes this one has.
  FixResidual(const TrackObservation& observation, const Eigen::Vector3d& weights, const Eigen::Vector3d& shares)
      : observation_(observation), weights_(weights), shares_(shares) {}

  template <class T>
  bool operator()(const T* position, const T* rotation, const T* lever_arm, const T* fix_error, const T* time_offset,
                  T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Vector p = Eigen::Map<const Vector>(position), lever = Eigen::Map<const Vector>(lever_arm);
    const Eigen::Map<const Vector> error(fix_error);
    const Eigen::Quaternion<T> q(Eigen::Map<const Eigen::Quaternion<T>>{rotation});
    const Vector antenna = observation_.antenna(p, q, lever, *time_offset);
    for (Eigen::Index i = 0; i < 3; ++i) {
      residual[i] = weights_[i] * (antenna[i] - observation_.position_m[i] + shares_[i] * error[i]);
    }
    return true;
  }

 private:
  TrackObservation observation_;
  Eigen::Vector3d weights_, shares_;
};

/// The road's normal against the vertical.
class LevelResidual {
 public:
  LevelResidual(const Eigen::Vector3d& up, double weight) : up_(up), weight_(weight) {}

  template <class T>
  bool operator()(const T* rotation, T* residual) const {
    const Eigen::Matrix<T, 3, 1> up = Eigen::Map<const Eigen::Quaternion<T>>(rotation) * up_.template cast<T>().eval();
    residual[0] = weight_ * up[0];
    residual[1] = weight_ * up[1];
    return true;
  }

 private:
  Eigen::Vector3d up_;
  double weight_;
};

}  // namespace roadstereo

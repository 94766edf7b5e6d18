#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "graph/fix_curve.hpp"
#include "graph/graph_pose.hpp"

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

/// Distance of the antenna from where the fixes have it at the time of a frame, in standard errors.
class FixResidual {
 public:
  FixResidual(const FixCurve& curve, double time_s, std::size_t segment, const Eigen::Vector3d& weights)
      : curve_(curve), time_s_(time_s), segment_(segment), weights_(weights) {}

  template <class T>
  bool operator()(const T* position, const T* rotation, const T* lever_arm, const T* fix_error, const T* time_offset,
                  T* residual) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vector> p(position), lever(lever_arm), error(fix_error);
    const Eigen::Map<const Eigen::Quaternion<T>> q(rotation);
    const Vector antenna = q * lever.eval() + p;
    const Vector fix = curve_.at(segment_, T(time_s_) + *time_offset) - error;
    for (Eigen::Index i = 0; i < 3; ++i) residual[i] = weights_[i] * (antenna[i] - fix[i]);
    return true;
  }

 private:
  const FixCurve& curve_;
  double time_s_;
  std::size_t segment_;
  Eigen::Vector3d weights_;
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

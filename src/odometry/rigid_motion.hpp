#pragma once

#include <cmath>

#include "core/cholesky.hpp"

namespace roadstereo {

/// Translation (metres), then rotation vector (radians).
using Twist = Vector<6>;

inline double dot(const Vector<3>& a, const Vector<3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector<3> cross(const Vector<3>& a, const Vector<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Rotation and translation: p becomes R·p + t.
struct RigidMotion {
  Matrix<3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vector<3> translation{};

  /// R·p.
  Vector<3> rotated(const Vector<3>& p) const {
    return {dot(rotation[0], p), dot(rotation[1], p), dot(rotation[2], p)};
  }

  Vector<3> operator()(const Vector<3>& p) const {
    const Vector<3> turned = rotated(p);
    return {turned[0] + translation[0], turned[1] + translation[1], turned[2] + translation[2]};
  }
};

/// Returns the motion that does `first`, then `second`.
inline RigidMotion operator*(const RigidMotion& second, const RigidMotion& first) {
  RigidMotion both;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      both.rotation[i][j] = second.rotation[i][0] * first.rotation[0][j] +
                            second.rotation[i][1] * first.rotation[1][j] + second.rotation[i][2] * first.rotation[2][j];
    }
  }
  both.translation = second(first.translation);
  return both;
}

inline RigidMotion inverse(const RigidMotion& motion) {
  RigidMotion back;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) back.rotation[i][j] = motion.rotation[j][i];
  }
  const Vector<3> turned = back.rotated(motion.translation);
  back.translation = {-turned[0], -turned[1], -turned[2]};
  return back;
}

/// Returns the motion that rotates by the rotation vector (Rodrigues' formula), then translates.
inline RigidMotion rigid_motion(const Twist& twist) {
  const Vector<3> w{twist[3], twist[4], twist[5]};
  const double squared = dot(w, w);
  const double angle = std::sqrt(squared);
  constexpr double tiny = 1e-6;  // series below it
  const double a = angle < tiny ? 1 - squared / 6 : std::sin(angle) / angle;
  const double b = angle < tiny ? 0.5 - squared / 24 : (1 - std::cos(angle)) / squared;
  RigidMotion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) motion.rotation[i][j] += b * (w[i] * w[j] - (i == j ? squared : 0));
  }
  const Matrix<3> skew{{{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) motion.rotation[i][j] += a * skew[i][j];
  }
  motion.translation = {twist[0], twist[1], twist[2]};
  return motion;
}

/// Inverse of `rigid_motion` for rotations by up to π.
inline Twist twist_of(const RigidMotion& motion) {
  const Matrix<3>& r = motion.rotation;
  const Vector<3> sine{(r[2][1] - r[1][2]) / 2, (r[0][2] - r[2][0]) / 2, (r[1][0] - r[0][1]) / 2};
  const double length = std::sqrt(dot(sine, sine)), cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
  const double angle = std::atan2(length, cosine);
  constexpr double near_half_turn = 1e-4;  // rounding has its share of the sine: (R + Rᵀ)/2 = cos + (1 − cos) a aᵀ
  Vector<3> axis = sine;
  double axis_length = length;
  if (cosine < 0 && length < near_half_turn) {
    const std::size_t k = r[0][0] > r[1][1] ? (r[0][0] > r[2][2] ? 0 : 2) : (r[1][1] > r[2][2] ? 1 : 2);
    for (std::size_t i = 0; i < 3; ++i) axis[i] = (r[i][k] + r[k][i]) / 2 - (i == k ? cosine : 0);
    axis_length = std::copysign(std::sqrt(dot(axis, axis)), dot(axis, sine));
  }
  const double scale = axis_length != 0 ? angle / axis_length : 1;
  return {motion.translation[0], motion.translation[1], motion.translation[2],
          scale * axis[0],       scale * axis[1],       scale * axis[2]};
}

/// Removes what rounding adds to the rotation: products of products would amplify it.
inline RigidMotion orthonormal(const RigidMotion& motion) {
  return rigid_motion(twist_of(motion));
}

}  // namespace roadstereo

#pragma once

#include <array>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Rigid transformation: 3×4, row-major, metres.
using RigidTransform = std::array<double, 12>;

/// Returns the product: `second` applied after `first`.
RigidTransform compose(const RigidTransform& second, const RigidTransform& first);
/// Returns the inverse.
RigidTransform inverse(const RigidTransform& transform);
/// Returns the largest difference of RᵀR from the identity, where R are the first three columns: 0 of a rotation.
double rotation_error(const RigidTransform& transform);
/// Returns the determinant of the first three columns: 1 of a rotation, −1 of a reflection, NaN if one of them is NaN.
double determinant(const RigidTransform& transform);
/// Returns a point, transformed.
std::array<double, 3> transform_point(const RigidTransform& transform, const std::array<double, 3>& point);
/// Returns a direction, rotated.
std::array<double, 3> rotate(const RigidTransform& transform, const std::array<double, 3>& direction);

}  // namespace roadstereo
#pragma GCC visibility pop

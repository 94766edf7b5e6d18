#pragma once

#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {

/// Whether column x of row v of the transformed target would come from outside the target image.
ROADSTEREO_HD inline bool comes_from_outside(const PerspectiveShift& shift, int x, int v) {
  return x - shift.at(x, v) < 0;
}

/// The transformation that undoes only a misalignment.
inline PerspectiveShift without_road(const Misalignment& misalignment) {
  PerspectiveShift shift;
  shift.enabled = false;
  shift.misalignment = misalignment;
  return shift;
}

/// How far left of column x of the transformed target its source lies in the target, pixels.
ROADSTEREO_HD inline double source_shift(const PerspectiveShift& shift, int x, int v) {
  return shift.at(x, v) - shift.misalignment.columns_at(v);
}

/// First column of row v whose source lies inside the target image; `width` when none does.
ROADSTEREO_HD inline int find_first_column(const PerspectiveShift& shift, int v, int width) {
  const double tilt = shift.road.a2 < 0.9 ? shift.road.a2 : 0.9;
  const double guess = shift.at(0, v) / (1 - tilt) - 2;
  int x = guess < 0 ? 0 : guess > width ? width : static_cast<int>(guess);
  while (x > 0 && !comes_from_outside(shift, x - 1, v)) --x;
  while (x < width && comes_from_outside(shift, x, v)) ++x;
  return x;
}

/// The line that a row of the road is, in single precision: offset + slope·u.
struct RowLine {
  float offset, slope;

  ROADSTEREO_HD float at(float u) const { return offset + slope * u; }
};

/// Row v of the plane, less `by`.
ROADSTEREO_HD inline RowLine row_line(const DisparityPlane& plane, int v, double by) {
  return {static_cast<float>(plane.disparity(0, v) - by), static_cast<float>(plane.a2)};
}

/// The line of the shifts of row v, Δu − δp; negative everywhere when the transformation is off.
ROADSTEREO_HD inline RowLine shift_line(const PerspectiveShift& shift, int v) {
  return shift.enabled ? row_line(shift.road, v, shift.delta_p) : RowLine{-1, 0};
}

/// Disparity between the original images of a residual disparity (NaN stays) in column u: the shift belongs to the
/// column of the transformed target that was matched. `road` is the row's line less δp.
ROADSTEREO_HD inline float with_shift(float residual, const RowLine& road, int u) {
  const float shift = road.at(static_cast<float>(u) - residual);
  return residual + (shift > 0.0F ? shift : 0.0F);
}

/// Inverse of with_shift: the residual disparity of one between the original images.
ROADSTEREO_HD inline float without_shift(float disparity, const RowLine& road, int u) {
  const float residual = (disparity - road.at(static_cast<float>(u))) / (1 - road.slope);
  return road.at(static_cast<float>(u) - residual) > 0.0F ? residual : disparity;
}

/// The same as with_shift where the shifts are whole pixels.
ROADSTEREO_HD inline float with_whole_shift(float residual, const PerspectiveShift& shift, int u, int v) {
  if (residual != residual) return residual;
  return residual + static_cast<float>(shift.at(u - static_cast<double>(residual), v));
}

}  // namespace roadstereo

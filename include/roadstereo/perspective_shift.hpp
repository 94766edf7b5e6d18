#pragma once

#include <cmath>

#include "roadstereo/disparity_plane.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Small error in the pose of the target camera that remains after rectification: a vertical shift, a rotation about
/// the optical axis and a scale of the rows. A point that should be at column x and row v is found `columns_at(v)` to
/// the right of that position and `rows_at(x, v)` below it, pixels.
struct Misalignment {
  static constexpr double max_px = 8;  ///< largest one that can be undone, pixels

  double rows_px = 0;    ///< offset of the rows at the principal point, pixels
  double turn_rad = 0;   ///< clockwise; it moves rows and columns
  double row_scale = 0;  ///< ratio of the height of the target view to that of the reference view, minus 1. Only its
                         ///< effect on the rows is undone, since a wrong focal length and a wrong tilt move the columns
                         ///< differently
  double cx_px = 0;      ///< principal point
  double cy_px = 0;

  ROADSTEREO_HD double columns_at(double v) const { return -turn_rad * (v - cy_px); }
  ROADSTEREO_HD double rows_at(double x, double v) const {
    return rows_px + turn_rad * (x - cx_px) + row_scale * (v - cy_px);
  }
  /// Returns the largest of |rows_at| and |columns_at| in a W×H image, pixels; NaN if a member is NaN.
  double largest_px(int width, int height) const {
    const double x = 0.5 * (width - 1), v = 0.5 * (height - 1);
    const double rows = std::abs(rows_at(x, v)) + std::abs(turn_rad) * x + std::abs(row_scale) * v;
    const double columns = std::abs(columns_at(v)) + std::abs(turn_rad) * v;
    return columns > rows ? columns : rows;
  }
  ROADSTEREO_HD bool is_zero() const { return rows_px == 0 && turn_rad == 0 && row_scale == 0; }
};

/// Shift of the perspective transformation: the target pixel at column x of the transformed image comes from column
/// x − at(x, v) of the target image. C++17, for kernels.
struct PerspectiveShift {
  DisparityPlane road;                               ///< Δu, eq. (4)
  double delta_p = 0;                                ///< δp, pixels: residual disparity of the road
  int disparities = 1;                               ///< D: residual disparities 0 … D−1 are searched
  bool whole_pixel = false;                          ///< shifts are rounded to whole pixels
  bool enabled = true;                               ///< false: every shift is 0
  Misalignment misalignment = {};                    ///< of the target; also undone
  double camera_height_m = assumed_camera_height_m;  ///< distance of the camera from the road plane, metres
  double disparity_offset_px = 0;                    ///< StereoCalibration::disparity_offset_px

  static constexpr double assumed_camera_height_m = 1.5;  ///< without a calibration: hand-held, on a car, a low drone

  /// max(0, Δu − δp), pixels.
  ROADSTEREO_HD double at(double x, double v) const {
    if (!enabled) return 0;
    const double beyond = road.disparity(x, v) - delta_p;
    const double bounded = beyond > 0 ? beyond : 0;
    return whole_pixel ? round(bounded) : bounded;
  }
};

}  // namespace roadstereo
#pragma GCC visibility pop

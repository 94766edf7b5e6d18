#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/matcher.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Pose of the left camera over a planar road, without roll.
struct CameraPose {
  double height_m = 2;                      ///< above the road, 0.05 … 1000
  double pitch_rad = std::numbers::pi / 2;  ///< of the optical axis below the horizon, −π/2 … π/2; π/2 looks down

  /// Throws Error naming the first value out of range.
  void validate() const;
};

/// Systematic error of sub-pixel disparities, which averaging does not remove, pixels: that of the parabola of `paper`;
/// `default` and `fast` have less (docs/accuracy.md).
inline constexpr double sub_pixel_bias_px = 0.03;

/// Return the smallest resolvable change of disparity, pixels: `threshold_sigma` standard errors, of `noise_px` and
/// `sub_pixel_bias_px`. `inspect` and `limits` both use it.
inline double resolvable_change_px(double noise_px, double threshold_sigma) {
  return threshold_sigma * std::hypot(noise_px, sub_pixel_bias_px);
}

struct ResolutionOptions {
  /// Standard deviation of the intact road in the transformed map, pixels, 0 … 10: `noise_px` of damages.json. 0.07 px
  /// is that of the flattest real roads (KITTI: 0.06 to 0.8 px), rendered ones in focus have 0.025.
  double noise_px = 0.07;
  double threshold_sigma = DamageOptions{}.threshold_sigma;  ///< resolvable depth in standard errors, 0.1 … 100
  double min_area_m2 = DamageOptions{}.min_area_m2;          ///< minimum area of the segmentation, m², 0 … 100
  double rut_width_m = 0.3;  ///< of the floor of a rut, 0.01 … 10; its depth is the mean over this width
  double rut_length_m = 1;   ///< and this length, 0.01 … 100
  MatcherOptions matcher;    ///< its support window bounds the resolvable area

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Resolution on the road in one row of the left image. Depths are along the road's normal.
struct RowResolution {
  double row_px = 0;
  double ahead_m = 0;             ///< distance on the road from the point below the camera, at the principal column
  double distance_m = 0;          ///< from the camera along the ray of that column
  double disparity_px = 0;        ///< of the road
  double step_m = 0;              ///< depth that lowers the disparity by one pixel; infinity if there is none
  double std_error_m = 0;         ///< depth of one standard error of the disparity
  double resolvable_depth_m = 0;  ///< depth of `resolvable_change_px`, of a pothole; infinity if there is none
  double resolvable_rut_m = 0;    ///< mean depth of a rut, whose floor averages over many support windows
  double gsd_across_m = 0;        ///< ground sampling distance along the row, metres per pixel
  double gsd_along_m = 0;         ///< ground sampling distance along the column, metres per pixel
  double swath_m = 0;             ///< width of the road in view of both cameras; 0 if the road is too close
  double resolvable_area_m2 = 0;  ///< smallest resolvable area, of a pothole
};

/// Depth and area that a rig resolves on a planar road from a height and a pitch.
///
/// The unit normal towards the road is n = (0, cos θ, sin θ). The ray of a pixel is r = ((u − u_o)/f, (v − v_o)/f, 1);
/// it meets the road at Z = h / (n·r). Let D = d + doffs = f·b / Z. A disparity lower by δ at the same pixel gives Z' =
/// f·b / (D − δ); the point Z'·r lies n·Z'r − h = h·(Z'/Z − 1) = h·δ / (D − δ) below the road. For a camera that looks
/// straight down and small δ this is Z²·δ / (f·b). A pixel covers Z/f of the road along the row and Z²/(h·f) along the
/// column. The resolvable area is that of the support window of a disparity, an ellipse of 2(R + r) + 1 columns and
/// 2(aspect·R + r) + 1 rows (block radius r, aggregation radius R): π/4 · columns · rows · across · along, at least
/// min_area_m2. The noise of the mean over a rut is that of a disparity over the root of the number of support windows.
class ResolutionLimits {
 public:
  /// Throws Error for options out of range, for a calibration without a size or refused by its `validate`, and if no
  /// row of the image shows the road within 1 km.
  ResolutionLimits(const StereoCalibration& calibration, const CameraPose& pose, const ResolutionOptions& options = {});

  /// First row that shows the road at Z ≤ 1 km, 0 … height − 1.
  double first_row() const { return first_row_; }
  double last_row() const;

  RowResolution at_row(double v) const;

  /// Resolution of `count` evenly spaced rows, from the last (nearest) to the first. Throws Error unless
  /// it is 2 … 65536.
  std::vector<RowResolution> rows(int count) const;

  /// Depth below the road, metres, at which the disparity of row v is lower by `change_px`; infinity if there is none.
  double depth_m(double v, double change_px) const;

  /// Farthest row in view that resolves `depth_m`; absent if there is none.
  std::optional<RowResolution> farthest(double depth_m) const;

  /// Maximum camera height, metres, at which the middle row resolves `depth_m` at this pitch; 0 if that row does not
  /// show the road.
  double max_camera_height_m(double depth_m) const;

 private:
  /// n·r at row v.
  double slant(double v) const;
  /// D = d + doffs of the road at row v, pixels.
  double road_disparity(double v) const;

  StereoCalibration calibration_;
  CameraPose pose_;
  ResolutionOptions options_;
  double first_row_ = 0;
};

}  // namespace roadstereo
#pragma GCC visibility pop

#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Where the left camera is over a plane road. Its rows are level: no roll.
struct CameraPose {
  double height_m = 2;                      ///< above the road, 0.05 … 1000
  double pitch_rad = std::numbers::pi / 2;  ///< of the optical axis below the horizon, −π/2 … π/2; π/2: straight down

  void validate() const;
};

struct ResolutionOptions {
  /// Standard error of the disparity of one pixel, pixels, 0.001 … 10. 0.1 px is the root mean square error of the
  /// default preset on rendered damage with ordinary texture (docs/accuracy.md); `sigma.tiff` tells it for a picture.
  double sigma_px = 0.1;
  double threshold_sigma = DamageOptions{}.threshold_sigma;  ///< standard errors that tell a depth apart, 0.1 … 100
  double min_area_m2 = DamageOptions{}.min_area_m2;          ///< segmentation keeps nothing smaller, 0 … 100
  MatcherOptions matcher;                                    ///< its windows bound the smallest area

  void validate() const;
};

/// What can be told apart where the road is seen in one row of the left image. Depths count along the road's normal.
struct RowResolution {
  double row_px = 0;
  double ahead_m = 0;             ///< on the road, from the foot of the camera, at the column of the principal point
  double distance_m = 0;          ///< from the camera, along the ray of that column
  double disparity_px = 0;        ///< of the road
  double step_m = 0;              ///< depth below the road that lowers the disparity by one pixel; infinite: by none
  double std_error_m = 0;         ///< depth of one standard error
  double resolvable_depth_m = 0;  ///< depth of threshold_sigma standard errors; infinite when none is enough
  double across_m = 0;            ///< road per pixel along the row
  double along_m = 0;             ///< road per pixel along the column
  double swath_m = 0;             ///< width of the road that both cameras see; 0: the road is too close for both
  double resolvable_area_m2 = 0;  ///< smallest area told apart
};

/// What a rig can tell apart of a road at a height and a pitch.
///
/// The road's normal towards the road is n = (0, cos θ, sin θ), a pixel's ray r = ((u − u_o)/f, (v − v_o)/f, 1), and
/// the road lies at Z = h / (n·r). With D = d + doffs = f·b / Z, a disparity lower by δ at the same pixel means Z' =
/// f·b / (D − δ), and the point Z'·r lies n·Z'r − h = h·(Z'/Z − 1) = h·δ / (D − δ) below the road. Straight down and
/// for small δ that is Z²·δ / (f·b). A pixel covers Z/f of the road along the row and Z²/(h·f) along the column. The
/// smallest area is that of the window that a disparity rests on, an ellipse of 2(R + r) + 1 columns and 2(aspect·R +
/// r) + 1 rows (block radius r, aggregation radius R), π/4 · columns · rows · across · along, and no less than
/// min_area_m2.
class ResolutionLimits {
 public:
  /// Throws Error for options out of range, a calibration without a size, and when no row of the image shows the road.
  ResolutionLimits(const StereoCalibration& calibration, const CameraPose& pose, const ResolutionOptions& options = {});

  /// First row that shows the road within a kilometre (of the distance along z), 0 … height − 1.
  double first_row() const { return first_row_; }
  double last_row() const;

  RowResolution at_row(double v) const;

  /// `count` rows, evenly from the last (nearest) to the first; at least 2.
  std::vector<RowResolution> rows(int count) const;

  /// Depth below the road of a disparity that is lower by `change_px`, metres; infinite when no point has it.
  double depth_m(double v, double change_px) const;

  /// The farthest row in view where that depth is told apart; absent when there is none.
  std::optional<RowResolution> farthest(double depth_m) const;

  /// The greatest height from which that depth is told apart in the middle row, at this pitch; 0 when that row does
  /// not show the road.
  double highest_camera_m(double depth_m) const;

 private:
  /// n·r of a row.
  double slant(double v) const;
  /// d + doffs of the road.
  double road_disparity(double v) const;

  StereoCalibration calibration_;
  CameraPose pose_;
  ResolutionOptions options_;
  double first_row_ = 0;
};

}  // namespace roadstereo

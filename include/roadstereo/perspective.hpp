#pragma once

#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/perspective_shift.hpp"
#include "roadstereo/road_model.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Sampling of the target image when its rows are shifted. `whole_pixel` requires LucasKanadeOptions::radius 0.
enum class ShiftPrecision { whole_pixel, sub_pixel };

/// What is searched after the shift.
enum class Scope {
  road,   ///< the road and its damage: objects on the road get no correct disparity
  scene,  ///< everything that the pair shows, vehicles and houses too: slower
};

/// Options of the perspective transformation, section 3.1.
struct PerspectiveOptions {
  bool enabled = true;  ///< false: no shift, plain stereo up to W/4
  ShiftPrecision shift = ShiftPrecision::sub_pixel;
  Scope scope = Scope::road;
  double max_damage_depth_m = 0.10;  ///< deepest measurable damage, metres, above 0, at most 2; without a calibration
                                     ///< the camera is assumed 1.5 m above the road
                                     ///< (PerspectiveShift::assumed_camera_height_m)
  double max_bump_height_m = 0.05;   ///< highest measurable bump, metres, above 0, at most 2; likewise
  int disparities = 0;               ///< number of disparities D searched after the shift, 1 … 1024; 0 derives it
  double delta_p_px = -1;  ///< δp: the road's disparity after the shift, pixels, less than the number of disparities;
                           ///< negative derives it

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Chooses δp and D: with a calibration from the deepest damage and the highest bump at the road's distance, without
/// one from the residuals of the correspondences; for the scene from the largest disparity, too, at most W/4. Without a
/// reliable model there is no shift, and all disparities up to that are searched. Throws Error if an option is out of
/// range, if the image, of width × height pixels, is not one of 32×32 … 8192×8192, and if the given δp is not less than
/// the number of disparities, which the width of the image bounds.
PerspectiveShift plan_perspective(const RoadModelEstimate& road, const std::optional<StereoCalibration>& calibration,
                                  int width, int height, const PerspectiveOptions& options);

/// Shifts the rows of the target image (π_tar → π_tar') horizontally, and undoes the misalignment of the rows.
/// `first_column[v]` becomes the first column of the transformed row that lies inside the target image (= width when
/// none does).
/// Throws Error for a misalignment of more than Misalignment::max_px.
void transform_target(ImageView<const std::int16_t> target, const PerspectiveShift& shift, int threads,
                      GreyImage& transformed, std::vector<int>& first_column);

/// Adds the shift Δu − δp back: residual disparities (pixels, NaN invalid) become those of the original images. Pixel
/// (x, y) of the maps is `pixel_step`·(x, y) of the image, as in MatcherOptions.
void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, int pixel_step, int threads,
                       Image<float>& disparity);

}  // namespace roadstereo
#pragma GCC visibility pop

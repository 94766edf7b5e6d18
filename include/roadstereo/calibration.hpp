#pragma once

#include <array>
#include <string>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Calibration of a rectified stereo rig: two pinhole cameras with common rows.
/// Camera frame: x right, y down, z forward, metres, origin at the left (reference) camera.
struct StereoCalibration {
  double focal_px = 0;             ///< focal length f, pixels
  double cx_px = 0;                ///< principal point u_o of the left image, pixels
  double cy_px = 0;                ///< principal point v_o, pixels
  double baseline_m = 0;           ///< distance t_c between the cameras, metres
  double disparity_offset_px = 0;  ///< cx of the right image minus cx of the left (Middlebury's doffs), pixels
  int width = 0;                   ///< image size of the calibration, pixels; 0 unknown
  int height = 0;

  /// Throws Error naming the value that is not finite or not plausible: focal length outside 0.2 … 50 image widths,
  /// baseline outside 5 mm … 10 m, principal point more than one image away from the image, disparity offset
  /// of more than an image width, size that is not `image_width` × `image_height`. `source` (a file name) begins the
  /// message.
  void validate(int image_width, int image_height, const std::string& source) const;

  /// Returns the distance along z of a pixel with the given disparity: Z = f·b / (d + doffs), metres; infinite where d
  /// + doffs is 0, negative where it is below 0.
  double depth_m(double disparity_px) const { return focal_px * baseline_m / (disparity_px + disparity_offset_px); }
  /// Returns the point (x, y, z) seen at pixel (u, v) with the given disparity, metres, camera frame.
  std::array<double, 3> point_m(double u, double v, double disparity_px) const {
    const double z = depth_m(disparity_px);
    return {(u - cx_px) / focal_px * z, (v - cy_px) / focal_px * z, z};
  }
};

}  // namespace roadstereo
#pragma GCC visibility pop

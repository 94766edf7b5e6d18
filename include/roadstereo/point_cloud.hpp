#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Unordered 3-D points with optional colours.
struct PointCloud {
  std::vector<std::array<float, 3>> points;          ///< (x, y, z), metres unless read from a file in another unit
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< (red, green, blue) per point; empty: no colours
};

/// Smallest disparity of the points of a cloud, pixels, 0 at infinity: an error of 0.1 px is a tenth of the distance.
inline constexpr double min_cloud_disparity_px = 1;

/// Triangulates a disparity map: camera frame (x right, y down, z forward), metres, row by row. Skips pixels without a
/// disparity, and with d + doffs below `min_cloud_disparity_px`.
PointCloud cloud_from_disparity(ImageView<const float> disparity, const StereoCalibration& calibration);
/// The same with the colours of the left image. `white_level` as in to_grey. Throws Error if the sizes differ or the
/// image has no data.
PointCloud cloud_from_disparity(ImageView<const float> disparity, const FrameView& left, double white_level,
                                const StereoCalibration& calibration);

/// Transforms the points to road axes, metres: the road is z = 0, depressions have z < 0.
PointCloud to_road_axes(const PointCloud& cloud, const RoadAxes& road);

}  // namespace roadstereo
#pragma GCC visibility pop

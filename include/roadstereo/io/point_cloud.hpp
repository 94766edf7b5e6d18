#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Points in space with their colours, in no particular order.
struct PointCloud {
  std::vector<std::array<float, 3>> points;          ///< (x, y, z); the unit is the producer's, metres in this program
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< (red, green, blue), one per point; empty: no colours
};

/// Farthest point that a cloud takes in, in baselines: there an error of a tenth of a pixel moves a point by several
/// metres with any usual camera.
inline constexpr double farthest_baselines = 250;

/// The points that a disparity map stands for: camera frame (x right, y down, z forward), metres, row by row, with the
/// colours of the left image. Left out are pixels without a disparity, with d + doffs ≤ 0, and farther away than
/// `farthest_baselines` baselines. `white_level` as in to_grey. Throws Error when the sizes differ.
PointCloud cloud_from_disparity(ImageView<const float> disparity, const FrameView& left, double white_level,
                                const StereoCalibration& calibration);

/// The same points in the axes of the road, metres: the road is z = 0, damage lies below.
PointCloud to_road_axes(const PointCloud& cloud, const RoadAxes& road);

/// Encodes a cloud as binary little-endian PLY: float x y z and, with colours, uchar red green blue. Throws Error when
/// there are colours, but not one per point.
std::vector<std::uint8_t> encode_ply(const PointCloud& cloud);

}  // namespace roadstereo::io

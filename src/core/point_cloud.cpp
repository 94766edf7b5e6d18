#include "roadstereo/point_cloud.hpp"

#include <cmath>

#include "core/colour_reader.hpp"
#include "core/require_size.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

std::uint8_t to_byte(float level) {
  return static_cast<std::uint8_t>(std::lrint(level));
}

std::array<float, 3> to_float(const std::array<double, 3>& point) {
  return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

/// Tells `use(u, v, point)` every point of the map, row by row.
template <class Use>
void for_each_point(const ImageView<const float>& disparity, const StereoCalibration& calibration, Use use) {
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double d = disparity(u, v);
      if (!std::isfinite(d) || d + calibration.disparity_offset_px < min_cloud_disparity_px) continue;
      use(u, v, to_float(calibration.point_m(u, v, d)));
    }
  }
}

}  // namespace

PointCloud cloud_from_disparity(ImageView<const float> disparity, const StereoCalibration& calibration) {
  PointCloud cloud;
  for_each_point(disparity, calibration,
                 [&](int, int, const std::array<float, 3>& point) { cloud.points.push_back(point); });
  return cloud;
}

PointCloud cloud_from_disparity(ImageView<const float> disparity, const FrameView& left, double white_level,
                                const StereoCalibration& calibration) {
  require_same_size("the disparity map", map_size(disparity), "the left image", {left.width, left.height});
  if (left.data == nullptr) fail("the image has no data");
  const ColourReader colours(left, white_level);
  PointCloud cloud;
  for_each_point(disparity, calibration, [&](int u, int v, const std::array<float, 3>& point) {
    cloud.points.push_back(point);
    const auto [red, green, blue] = colours.pixel(u, v);
    cloud.colours.push_back({to_byte(red), to_byte(green), to_byte(blue)});
  });
  return cloud;
}

PointCloud to_road_axes(const PointCloud& cloud, const RoadAxes& road) {
  PointCloud turned{{}, cloud.colours};
  turned.points.reserve(cloud.points.size());
  for (const auto& [x, y, z] : cloud.points) turned.points.push_back(to_float(road.to_road({x, y, z})));
  return turned;
}

}  // namespace roadstereo

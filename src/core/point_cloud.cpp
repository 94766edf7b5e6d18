#include "roadstereo/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

using Colour = std::array<std::uint8_t, 3>;

std::array<float, 3> to_float(const std::array<double, 3>& point) {
  return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

/// Tells `use(u, v, point)` every point of the map, row by row.
template <class Use>
void for_each_point(const ImageView<const float>& disparity, const StereoCalibration& calibration, Use use) {
  const double min_px = calibration.focal_px / farthest_baselines;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double d = disparity(u, v);
      if (!std::isfinite(d) || d + calibration.disparity_offset_px < min_px) continue;
      use(u, v, to_float(calibration.point_m(u, v, d)));
    }
  }
}

/// Red, green, blue of 8 bits.
template <class Sample>
Colour colour_at(const FrameView& frame, float scale, int u, int v) {
  const auto* row = static_cast<const std::uint8_t*>(frame.data) + v * frame.stride_bytes;
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(u) * channel_count(frame.order);
  const auto narrow = [&](int channel) {
    Sample sample;
    std::memcpy(&sample, row + (first + channel) * static_cast<std::ptrdiff_t>(sizeof(Sample)), sizeof(Sample));
    return static_cast<std::uint8_t>(std::lrint(std::min(255.0F, scale * static_cast<float>(sample))));
  };
  switch (frame.order) {
    case ChannelOrder::grey:
      return {narrow(0), narrow(0), narrow(0)};
    case ChannelOrder::bgr:
    case ChannelOrder::bgra:
      return {narrow(2), narrow(1), narrow(0)};
    case ChannelOrder::rgb:
    case ChannelOrder::rgba:
      break;
  }
  return {narrow(0), narrow(1), narrow(2)};
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
  if (disparity.width() != left.width || disparity.height() != left.height) {
    fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels and the left image ",
         left.width, "×", left.height, "; they must have the same size");
  }
  const bool wide = left.sample == SampleType::u16;
  const double white = white_level > 0 ? white_level : 65535.0;
  const float scale = wide ? static_cast<float>(255.0 / white) : 1.0F;
  PointCloud cloud;
  for_each_point(disparity, calibration, [&](int u, int v, const std::array<float, 3>& point) {
    cloud.points.push_back(point);
    cloud.colours.push_back(wide ? colour_at<std::uint16_t>(left, scale, u, v)
                                 : colour_at<std::uint8_t>(left, scale, u, v));
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

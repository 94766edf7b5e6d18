#include "roadstereo/io/point_cloud.hpp"

#include <cmath>
#include <opencv2/core.hpp>

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::array<float, 3> to_float(const std::array<double, 3>& point) {
  return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}

}  // namespace

PointCloud cloud_from_disparity(ImageView<const float> disparity, const FrameView& left, double white_level,
                                const StereoCalibration& calibration) {
  if (disparity.width() != left.width || disparity.height() != left.height) {
    fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels and the left image ",
         left.width, "×", left.height, "; they must have the same size");
  }
  const double largest = left.sample == SampleType::u16 ? 65535.0 : 255.0;
  const cv::Mat picture = to_bgr(left, white_level > 0 ? white_level : largest);
  const double min_px = calibration.focal_px / farthest_baselines;
  PointCloud cloud;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double d = disparity(u, v);
      if (!std::isfinite(d) || d + calibration.disparity_offset_px < min_px) continue;
      const auto& bgr = picture.at<cv::Vec3b>(v, u);
      cloud.points.push_back(to_float(calibration.point_m(u, v, d)));
      cloud.colours.push_back({bgr[2], bgr[1], bgr[0]});
    }
  }
  return cloud;
}

PointCloud to_road_axes(const PointCloud& cloud, const RoadAxes& road) {
  PointCloud turned{{}, cloud.colours};
  turned.points.reserve(cloud.points.size());
  for (const auto& [x, y, z] : cloud.points) turned.points.push_back(to_float(road.to_road({x, y, z})));
  return turned;
}

}  // namespace roadstereo::io

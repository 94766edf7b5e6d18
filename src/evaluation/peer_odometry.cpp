#include "evaluation/peer_odometry.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "evaluation/peer_maps.hpp"

namespace roadstereo::io {

struct OpticalFlowOdometry::State {
  StereoCalibration calibration;
  cv::Mat grey;
  Image<float> disparity;
};

OpticalFlowOdometry::OpticalFlowOdometry(const StereoCalibration& calibration) : state_(std::make_unique<State>()) {
  state_->calibration = calibration;
}
OpticalFlowOdometry::~OpticalFlowOdometry() = default;

std::optional<std::array<double, 12>> OpticalFlowOdometry::add(const GreyImage& grey, const Image<float>& disparity) {
  const cv::Mat bytes = grey_bytes(grey);
  const cv::Mat before = state_->grey;
  const Image<float> depths = state_->disparity;
  state_->grey = bytes;
  state_->disparity = disparity;
  if (before.empty()) return std::nullopt;

  constexpr int max_corners = 2000;
  constexpr double quality = 0.003, min_distance = 7, max_return_px = 0.5;
  std::vector<cv::Point2f> corners, moved, returned;
  cv::goodFeaturesToTrack(before, corners, max_corners, quality, min_distance);
  if (corners.empty()) return std::nullopt;
  std::vector<std::uint8_t> found, found_back;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(before, bytes, corners, moved, found, errors, {21, 21}, 4);
  cv::calcOpticalFlowPyrLK(bytes, before, moved, returned, found_back, errors, {21, 21}, 4);
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (found[i] == 0 || found_back[i] == 0 || cv::norm(corners[i] - returned[i]) > max_return_px) continue;
    const double d = depths(cvRound(corners[i].x), cvRound(corners[i].y));
    if (!(d > min_peer_disparity_px)) continue;
    const auto p = state_->calibration.point_m(corners[i].x, corners[i].y, d);
    points.emplace_back(p[0], p[1], p[2]);
    pixels.emplace_back(moved[i]);
  }
  constexpr std::size_t min_points = 10;
  if (points.size() < min_points) return std::nullopt;
  const StereoCalibration& c = state_->calibration;
  const cv::Matx33d camera(c.focal_px, 0, c.cx_px, 0, c.focal_px, c.cy_px, 0, 0, 1);
  cv::Vec3d rotation, translation;
  cv::Mat inliers;
  constexpr int iterations = 300;
  constexpr float threshold_px = 1;
  if (!cv::solvePnPRansac(points, pixels, camera, cv::noArray(), rotation, translation, false, iterations, threshold_px,
                          0.999, inliers)) {
    return std::nullopt;
  }
  cv::Matx33d r;
  cv::Rodrigues(rotation, r);
  return std::array{r(0, 0), r(0, 1),        r(0, 2), translation[0], r(1, 0), r(1, 1),
                    r(1, 2), translation[1], r(2, 0), r(2, 1),        r(2, 2), translation[2]};
}

}  // namespace roadstereo::io

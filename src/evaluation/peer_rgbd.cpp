#include "evaluation/peer_rgbd.hpp"

#include <algorithm>
#include <opencv2/rgbd/depth.hpp>

#include "evaluation/peer_maps.hpp"

namespace roadstereo::io {

struct RgbdOdometry::State {
  StereoCalibration calibration;
  cv::Ptr<cv::rgbd::RgbdOdometry> odometry;
  cv::Ptr<cv::rgbd::OdometryFrame> last;
  cv::Mat motion = cv::Mat::eye(4, 4, CV_64F);
};

bool RgbdOdometry::available() {
  return true;
}

RgbdOdometry::RgbdOdometry(const StereoCalibration& calibration) : state_(std::make_unique<State>()) {
  constexpr double max_translation_m = 5, max_rotation_deg = 30;  // of a frame
  state_->calibration = calibration;
  const cv::Mat camera = (cv::Mat_<double>(3, 3) << calibration.focal_px, 0, calibration.cx_px, 0, calibration.focal_px,
                          calibration.cy_px, 0, 0, 1);
  state_->odometry = cv::rgbd::RgbdOdometry::create(camera);
  state_->odometry->setMaxDepth(calibration.focal_px * calibration.baseline_m / min_peer_disparity_px);
  state_->odometry->setMaxTranslation(max_translation_m);
  state_->odometry->setMaxRotation(max_rotation_deg);
}
RgbdOdometry::~RgbdOdometry() = default;

std::optional<std::array<double, 12>> RgbdOdometry::add(const GreyImage& grey, const Image<float>& disparity) {
  State& s = *state_;
  auto frame = cv::rgbd::OdometryFrame::create(grey_bytes(grey), depths_m(disparity, s.calibration),
                                               cv::Mat(grey.height(), grey.width(), CV_8U, cv::Scalar(255)));
  cv::Ptr<cv::rgbd::OdometryFrame> last = s.last;
  s.last = frame;
  if (last.empty()) return std::nullopt;
  cv::Mat found;
  if (!s.odometry->compute(last, frame, found, s.motion)) return std::nullopt;
  found.convertTo(s.motion, CV_64F);
  std::array<double, 12> motion{};
  std::copy_n(s.motion.ptr<double>(), motion.size(), motion.begin());  // row-major, 4×4
  return motion;
}

}  // namespace roadstereo::io

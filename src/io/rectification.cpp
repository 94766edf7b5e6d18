#include "roadstereo/io/rectification.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <tuple>

#include "core/resampling.hpp"
#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Rotations to the rectified cameras and their projection matrices.
struct RectifiedCameras {
  cv::Matx33d left_rotation;
  cv::Matx33d right_rotation;
  cv::Matx34d left;
  cv::Matx34d right;
};

/// Source coordinates of each pixel of a rectified image.
struct PixelMap {
  cv::Mat x;
  cv::Mat y;
};

cv::Matx33d matrix_of(const std::array<double, 9>& values) {
  return cv::Matx33d(values.data());
}

std::string size_text(int width, int height) {
  return std::to_string(width) + "×" + std::to_string(height);
}

void check_size(const StereoRig& rig, int width, int height) {
  if (rig.width != 0 && (rig.width != width || rig.height != height)) {
    fail("the calibration is for ", size_text(rig.width, rig.height), " pixels, but the images have ",
         size_text(width, height), ": scale the calibration, or record at ", size_text(rig.width, rig.height));
  }
}

/// The right camera must be at the right of the left one, since rows become epipolar lines.
void check_arrangement(const StereoRig& rig) {
  const cv::Vec3d translation(rig.translation_m.data());
  const cv::Vec3d centre = matrix_of(rig.rotation).t() * -translation;  // of the right camera in the left one's frame
  const double sideways = std::abs(centre[0]);
  const auto reject = [](const char* where, double distance) {
    fail("the right camera is ", std::abs(distance), " m ", where, " the left one; it must be to the right of it");
  };
  if (std::abs(centre[1]) >= sideways && std::abs(centre[1]) >= std::abs(centre[2])) {
    reject(centre[1] > 0 ? "below" : "above", centre[1]);
  }
  if (std::abs(centre[2]) >= sideways) reject(centre[2] > 0 ? "in front of" : "behind", centre[2]);
  if (centre[0] <= 0) {
    fail("the right camera is ", -centre[0],
         " m to the left of the left one; the cameras are swapped, or T has the wrong sign: exchange the two files, or "
         "the "
         "left and right images");
  }
}

RectifiedCameras rectified_cameras(const StereoRig& rig, cv::Size size) {
  const cv::Matx33d k1 = matrix_of(rig.left_matrix);
  const cv::Matx33d k2 = matrix_of(rig.right_matrix);
  const cv::Matx33d rotation = matrix_of(rig.rotation);
  const cv::Vec3d translation(rig.translation_m.data());
  RectifiedCameras cameras;
  cv::Matx44d unused;
  if (rig.fisheye) {
    const std::vector<double> none(4, 0.0);
    cv::fisheye::stereoRectify(k1, rig.left_distortion.empty() ? none : rig.left_distortion, k2,
                               rig.right_distortion.empty() ? none : rig.right_distortion, size, rotation, translation,
                               cameras.left_rotation, cameras.right_rotation, cameras.left, cameras.right, unused,
                               cv::CALIB_ZERO_DISPARITY, size, 0, 1);
  } else {
    cv::stereoRectify(k1, rig.left_distortion, k2, rig.right_distortion, size, rotation, translation,
                      cameras.left_rotation, cameras.right_rotation, cameras.left, cameras.right, unused,
                      cv::CALIB_ZERO_DISPARITY, 0, size);
  }
  return cameras;
}

PixelMap pixel_map(const std::array<double, 9>& matrix, const std::vector<double>& distortion, bool fisheye,
                   const cv::Matx33d& rotation, const cv::Matx34d& projection, cv::Size size) {
  const cv::Matx33d k = matrix_of(matrix);
  const cv::Matx33d p = projection.get_minor<3, 3>(0, 0);
  PixelMap map;
  if (fisheye) {
    const std::vector<double> d = distortion.empty() ? std::vector<double>(4, 0.0) : distortion;
    cv::fisheye::initUndistortRectifyMap(k, d, rotation, p, size, CV_32FC1, map.x, map.y);
  } else {
    cv::initUndistortRectifyMap(k, distortion, rotation, p, size, CV_32FC1, map.x, map.y);
  }
  return map;
}

bool lies_inside(const PixelMap& map, cv::Size size) {
  constexpr double tolerance_px = 0.5;  // half a pixel
  const auto within = [](const cv::Mat& coordinate, int side) {
    double smallest = 0;
    double largest = 0;
    cv::minMaxLoc(coordinate, &smallest, &largest);
    return smallest >= -tolerance_px && largest <= side - 1 + tolerance_px;
  };
  return within(map.x, size.width) && within(map.y, size.height);
}

/// Computes both maps so that all pixels have image content. OpenCV's choice of the focal length is approximate (it
/// tests a few points of the border) and wrong for fisheye lenses, so the view is narrowed step by step.
std::pair<PixelMap, PixelMap> inner_maps(const StereoRig& rig, cv::Size size, RectifiedCameras& cameras) {
  constexpr double zoom = 1.01;
  constexpr int max_steps = 160;  // up to about five times the focal length
  for (int step = 0; step < max_steps; ++step) {
    PixelMap left =
        pixel_map(rig.left_matrix, rig.left_distortion, rig.fisheye, cameras.left_rotation, cameras.left, size);
    PixelMap right =
        pixel_map(rig.right_matrix, rig.right_distortion, rig.fisheye, cameras.right_rotation, cameras.right, size);
    if (lies_inside(left, size) && lies_inside(right, size)) return {std::move(left), std::move(right)};
    for (cv::Matx34d* p : {&cameras.left, &cameras.right}) {
      (*p)(0, 0) *= zoom;
      (*p)(1, 1) *= zoom;
      (*p)(0, 3) *= zoom;  // f·T
    }
  }
  const std::string doubt =
      rig.width == 0 ? principal_point_doubt(rig.left_matrix[2], rig.left_matrix[5], size.width, size.height) : "";
  fail("the rig cannot be rectified: ",
       doubt.empty() ? "the optical axes diverge too much, or a distortion is out of range" : doubt);
}

Frame resample(const Frame& frame, const PixelMap& map, int threads) {
  const auto view = [](const cv::Mat& places) {
    return ImageView<const float>(places.ptr<float>(), places.cols, places.rows);
  };
  return roadstereo::resample(frame.view(), view(map.x), view(map.y), threads);
}

StereoCalibration calibration_of(const RectifiedCameras& cameras, cv::Size size) {
  StereoCalibration calibration;
  calibration.focal_px = cameras.left(0, 0);
  calibration.cx_px = cameras.left(0, 2);
  calibration.cy_px = cameras.left(1, 2);
  calibration.baseline_m = -cameras.right(0, 3) / cameras.right(0, 0);
  calibration.disparity_offset_px = cameras.right(0, 2) - cameras.left(0, 2);
  calibration.width = size.width;
  calibration.height = size.height;
  calibration.validate(size.width, size.height, "the rectified rig");
  return calibration;
}

}  // namespace

struct Rectifier::Maps {
  cv::Size size;
  PixelMap left;
  PixelMap right;
  StereoCalibration calibration;
  int threads = 0;
};

Rectifier::Rectifier(const StereoRig& rig, int width, int height, int threads) : maps_(std::make_unique<Maps>()) {
  check_size(rig, width, height);
  if (std::min(width, height) < 2)
    fail("the images have ", size_text(width, height), " pixels; rectification needs 2×2");
  StereoRig sized = rig;
  sized.width = width;
  sized.height = height;
  check_rig(sized, "the rig");
  check_arrangement(sized);
  maps_->size = cv::Size(width, height);
  maps_->threads = threads;
  try {
    RectifiedCameras cameras = rectified_cameras(sized, maps_->size);
    std::tie(maps_->left, maps_->right) = inner_maps(rig, maps_->size, cameras);
    maps_->calibration = calibration_of(cameras, maps_->size);
  } catch (const cv::Exception& error) {
    fail("the rig cannot be rectified: ", error.err);
  }
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

const StereoCalibration& Rectifier::calibration() const {
  return maps_->calibration;
}

RectifiedPair Rectifier::rectify(const Frame& left, const Frame& right) const {
  for (const Frame* frame : {&left, &right}) {
    if (frame->width == maps_->size.width && frame->height == maps_->size.height) continue;
    fail("the image has ", size_text(frame->width, frame->height), " pixels, but the rig ",
         size_text(maps_->size.width, maps_->size.height));
  }
  const int threads = maps_->threads;
  return {resample(left, maps_->left, threads), resample(right, maps_->right, threads), maps_->calibration};
}

RectifiedPair rectify(const Frame& left, const Frame& right, const StereoRig& rig, int threads) {
  if (left.width != right.width || left.height != right.height) {
    fail("the left image has ", size_text(left.width, left.height), " pixels, the right one ",
         size_text(right.width, right.height), "; both must have the same");
  }
  return Rectifier(rig, left.width, left.height, threads).rectify(left, right);
}

}  // namespace roadstereo::io

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "roadstereo/error.hpp"
#include "roadstereo/io/rectification.hpp"

namespace {

using namespace roadstereo;
using namespace roadstereo::io;

constexpr int width = 640;
constexpr int height = 480;
constexpr int columns = 5;
constexpr int rows = 4;

std::vector<cv::Point3d> target_points() {
  std::vector<cv::Point3d> points;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      points.emplace_back(-0.4 + 0.2 * j, -0.3 + 0.2 * i, 2.0 + 0.07 * ((i * columns + j) % 3));
    }
  }
  return points;
}

StereoRig skewed_rig() {
  cv::Matx33d rotation;
  cv::Rodrigues(cv::Vec3d(0.01, -0.03, 0.02), rotation);
  StereoRig rig;
  rig.left_matrix = {500, 0, 325, 0, 503, 236, 0, 0, 1};
  rig.right_matrix = {508, 0, 314, 0, 506, 244, 0, 0, 1};
  rig.left_distortion = {-0.15, 0.04, 0.001, -0.001, 0};
  rig.right_distortion = {-0.12, 0.02, -0.001, 0.0005, 0};
  std::copy(rotation.val, rotation.val + 9, rig.rotation.begin());
  rig.translation_m = {-0.12, 0.004, -0.003};
  rig.width = width;
  rig.height = height;
  return rig;
}

/// A picture of small bright spots where the camera sees the points.
Frame spots(const std::vector<cv::Point2d>& places) {
  Frame frame{{}, width, height, SampleType::u16, ChannelOrder::grey};
  cv::Mat image(height, width, CV_16UC1, cv::Scalar(5000));
  for (const cv::Point2d& place : places) {
    for (int v = cvRound(place.y) - 12; v <= cvRound(place.y) + 12; ++v) {
      for (int u = cvRound(place.x) - 12; u <= cvRound(place.x) + 12; ++u) {
        if (u < 0 || v < 0 || u >= width || v >= height) continue;
        const double square = (u - place.x) * (u - place.x) + (v - place.y) * (v - place.y);
        image.at<std::uint16_t>(v, u) = cv::saturate_cast<std::uint16_t>(5000 + 40000 * std::exp(-square / 18));
      }
    }
  }
  frame.bytes.assign(image.data, image.data + image.total() * image.elemSize());
  return frame;
}

std::vector<cv::Point2d> project(const std::array<double, 9>& k, const std::vector<double>& d, bool fisheye,
                                 const cv::Matx33d& rotation, const cv::Vec3d& translation) {
  cv::Vec3d turn;
  cv::Rodrigues(rotation, turn);
  std::vector<cv::Point2d> places;
  if (fisheye) {
    cv::fisheye::projectPoints(target_points(), places, turn, translation, cv::Matx33d(k.data()), d);
  } else {
    cv::projectPoints(target_points(), turn, translation, cv::Matx33d(k.data()), d, places);
  }
  return places;
}

/// Centres of the spots, row by row.
std::vector<cv::Point2d> find_spots(const Frame& frame) {
  const cv::Mat image(frame.height, frame.width, CV_16UC1, const_cast<std::uint8_t*>(frame.bytes.data()));
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(image > 9000, labels, stats, centroids);
  std::vector<cv::Point2d> sums(static_cast<std::size_t>(count));
  std::vector<double> weights(static_cast<std::size_t>(count));
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const auto label = static_cast<std::size_t>(labels.at<int>(v, u));
      const double weight = image.at<std::uint16_t>(v, u) - 5000.0;
      sums[label] += weight * cv::Point2d(u, v);
      weights[label] += weight;
    }
  }
  std::vector<cv::Point2d> centres;
  for (std::size_t i = 1; i < sums.size(); ++i) centres.push_back(sums[i] / weights[i]);
  std::sort(centres.begin(), centres.end(), [](auto a, auto b) { return a.y < b.y; });
  for (auto row = centres.begin(); centres.end() - row >= columns; row += columns) {
    std::sort(row, row + columns, [](auto a, auto b) { return a.x < b.x; });
  }
  return centres;
}

/// Rectifies pictures of known points and measures them: rows must agree and distances must be true.
void expect_true_geometry(const StereoRig& rig) {
  const Frame left =
      spots(project(rig.left_matrix, rig.left_distortion, rig.fisheye, cv::Matx33d::eye(), cv::Vec3d(0, 0, 0)));
  const Frame right = spots(project(rig.right_matrix, rig.right_distortion, rig.fisheye,
                                    cv::Matx33d(rig.rotation.data()), cv::Vec3d(rig.translation_m.data())));
  const RectifiedPair pair = rectify(left, right, rig);
  ASSERT_EQ(pair.left.sample, SampleType::u16);
  ASSERT_EQ(pair.left.width, width);
  ASSERT_EQ(pair.right.height, height);
  const auto& t = rig.translation_m;
  EXPECT_NEAR(pair.calibration.baseline_m, std::hypot(t[0], t[1], t[2]), 1e-9);
  const std::vector<cv::Point2d> in_left = find_spots(pair.left);
  const std::vector<cv::Point2d> in_right = find_spots(pair.right);
  const std::vector<cv::Point3d> truth = target_points();
  ASSERT_EQ(in_left.size(), truth.size());
  ASSERT_EQ(in_right.size(), truth.size());
  std::vector<cv::Point3d> measured;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(in_left[i].y, in_right[i].y, 0.1) << "spot " << i;
    const auto point = pair.calibration.point_m(in_left[i].x, in_left[i].y, in_left[i].x - in_right[i].x);
    measured.emplace_back(point[0], point[1], point[2]);
    EXPECT_NEAR(cv::norm(measured[i]), cv::norm(truth[i]), 0.015) << "spot " << i;
  }
  for (std::size_t i = 1; i < truth.size(); ++i) {
    EXPECT_NEAR(cv::norm(measured[i] - measured[0]), cv::norm(truth[i] - truth[0]), 0.02) << "spot " << i;
  }
}

TEST(Rectification, AlignsSkewedPinholeRig) {
  expect_true_geometry(skewed_rig());
}

TEST(Rectification, AlignsFisheyeRig) {
  StereoRig rig = skewed_rig();
  rig.fisheye = true;
  rig.left_distortion = {-0.02, 0.005, -0.001, 0};
  rig.right_distortion = {-0.015, 0.004, 0, 0};
  expect_true_geometry(rig);
}

TEST(Rectification, TakesSizeFromImage) {
  StereoRig rig = skewed_rig();
  rig.width = 0;
  rig.height = 0;
  expect_true_geometry(rig);
}

/// The outermost pixels of the image are dark: they may be seen, but only as a line; whatever looks further
/// out would repeat them in a band.
TEST(Rectification, IsBlackBeyondImage) {
  Frame frame{{}, width, height, SampleType::u8, ChannelOrder::bgr};
  cv::Mat image(height, width, CV_8UC3, cv::Scalar::all(200));
  cv::rectangle(image, cv::Rect(0, 0, width, height), cv::Scalar::all(0));
  frame.bytes.assign(image.data, image.data + image.total() * image.elemSize());
  StereoRig fisheye = skewed_rig();
  fisheye.fisheye = true;
  fisheye.left_distortion = {-0.05, 0.01, 0, 0};
  fisheye.right_distortion = {-0.05, 0.01, 0, 0};
  for (const StereoRig& rig : {skewed_rig(), fisheye}) {
    const RectifiedPair pair = rectify(frame, frame, rig);
    ASSERT_EQ(pair.left.bytes.size(), frame.bytes.size());
    for (const Frame* side : {&pair.left, &pair.right}) {
      const auto dark = std::count_if(side->bytes.begin(), side->bytes.end(), [](int sample) { return sample < 100; });
      EXPECT_LT(dark / 3, 2 * (width + height));
    }
  }
  const RectifiedPair pair = rectify(frame, frame, skewed_rig());
  EXPECT_EQ(pair.calibration.width, width);
  EXPECT_EQ(pair.calibration.disparity_offset_px, 0);
}

std::string message_of(const StereoRig& rig, int frame_width = width) {
  const Frame frame{std::vector<std::uint8_t>(static_cast<std::size_t>(frame_width) * height, 9), frame_width, height,
                    SampleType::u8, ChannelOrder::grey};
  try {
    rectify(frame, frame, rig);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_refused(const StereoRig& rig, const std::string& part) {
  const std::string message = message_of(rig);
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

StereoRig rig_with_translation(double x, double y, double z) {
  StereoRig rig = skewed_rig();
  rig.translation_m = {x, y, z};
  return rig;
}

/// 640×360 with the principal point and the distortion of 1280×720.
TEST(Rectification, TellsScaledImagesInsteadOfDistortion) {
  StereoRig rig = rig_with_translation(-0.12, 0, 0);
  rig.width = rig.height = 0;
  for (std::array<double, 9>* matrix : {&rig.left_matrix, &rig.right_matrix}) {
    *matrix = {850, 0, 639.5, 0, 850, 359.5, 0, 0, 1};
  }
  rig.left_distortion = rig.right_distortion = {-0.4, 0.2, 0, 0, 0};
  EXPECT_NO_THROW(Rectifier(rig, 1280, 720));
  rig.left_distortion = rig.right_distortion = {40, 0, 0, 0, 0};
  try {
    Rectifier(rig, 640, 360);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("it suggests 1280×720"), std::string::npos) << error.what();
  }
}

TEST(Rectification, RejectsBadRigs) {
  expect_refused(rig_with_translation(0.12, 0, 0), "to the left of the left one; the cameras are swapped");
  expect_refused(rig_with_translation(0, -0.12, 0), "below the left one");
  expect_refused(rig_with_translation(0, 0.12, 0), "above the left one");
  expect_refused(rig_with_translation(0, 0, -0.12), "in front of the left one");
  expect_refused(rig_with_translation(0, 0, 0), "the baseline is 0;");
  expect_refused(rig_with_translation(-60, 0, 0), "the baseline is 60;");
  StereoRig rig = skewed_rig();
  rig.left_matrix[0] = 3;
  expect_refused(rig, "the focal length is 3;");
  rig = skewed_rig();
  rig.right_distortion[1] = std::nan("");
  expect_refused(rig, "D2 is nan");
  const std::string message = message_of(skewed_rig(), 600);
  EXPECT_NE(message.find("640×480"), std::string::npos) << message;
  EXPECT_NE(message.find("600×480"), std::string::npos) << message;
}

}  // namespace

// roadstereo/opencv.hpp: matrices as frames and maps as matrices without a copy, and the matcher behind OpenCV's
// interface.

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/opencv.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {
namespace {

/// Grey levels of a view, in sixteenths.
GreyImage grey_of(const FrameView& view) {
  GreyImage grey;
  to_grey(view, 0, grey);
  return grey;
}

TEST(OpenCvViews, PartOfMatrixIsFrameWithoutCopy) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    cv::Mat whole(60, 70, type, cv::Scalar::all(0));
    cv::Mat part = whole(cv::Rect(20, 10, 40, 36));
    const double white = part.depth() == CV_16U ? 65535 : 255;
    part.setTo(cv::Scalar::all(white));
    part.at<std::uint8_t>(0, 0) = 0;  // a byte of the first pixel: blue, or the lower half of it
    const FrameView view = opencv::frame_view(part);
    EXPECT_EQ(view.data, part.data);
    EXPECT_EQ(view.stride_bytes, static_cast<std::ptrdiff_t>(whole.step[0]));
    const GreyImage grey = grey_of(view);
    EXPECT_EQ(grey.width(), 40);
    EXPECT_EQ(grey.height(), 36);
    EXPECT_EQ(grey(39, 35), 4080) << type;
    if (type == CV_8UC3 || type == CV_8UC4) {
      EXPECT_EQ(grey(0, 0), 3615) << "blue is 0.114 of 4080";
    }
  }
}

TEST(OpenCvViews, OtherMatricesAreErrorsThatNameTheirType) {
  const auto message = [](const cv::Mat& image) -> std::string {
    try {
      opencv::frame_view(image);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(cv::Mat(40, 40, CV_32FC1)).find("CV_32FC1"), std::string::npos);
  EXPECT_NE(message(cv::Mat(40, 40, CV_8UC2)).find("CV_8UC2"), std::string::npos);
  EXPECT_NE(message(cv::Mat(40, 40, CV_8SC3)).find("CV_8SC3"), std::string::npos);
  const int sides[] = {40, 40, 40};
  EXPECT_NE(message(cv::Mat(3, sides, CV_8UC1)).find("3 dimensions"), std::string::npos);
  EXPECT_NE(message(cv::Mat()).find("empty"), std::string::npos);
}

TEST(OpenCvViews, MapsAreMatricesWithoutCopy) {
  Image<float> map(50, 40, 1.5F);
  cv::Mat mat = opencv::mat_view(map);
  EXPECT_EQ(mat.type(), CV_32FC1);
  EXPECT_EQ(mat.size(), cv::Size(50, 40));
  mat.at<float>(39, 49) = 7;
  EXPECT_EQ(map(49, 39), 7);
  const Image<float>& const_map = map;
  EXPECT_EQ(opencv::mat_view(const_map).ptr<float>(0), const_map.row(0));
  EXPECT_EQ(opencv::mat_view(ImageView<const float>(map.row(0), 25, 40, 50)).at<float>(1, 24), 1.5F);
  EXPECT_EQ(opencv::mat_view(GreyImage(2, 2, 3).view()).type(), CV_16SC1);
  Image<std::uint8_t> mask(2, 2);
  EXPECT_EQ(opencv::mat_view(mask).type(), CV_8UC1);
  EXPECT_TRUE(opencv::mat_view(Image<float>().view()).empty());
}

class OpenCvMatcher : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    synth::Scene scene = synth::named_scene("uav");
    scene.supersampling = 1;
    pair_ = new synth::SyntheticPair(synth::render(scene));
  }
  static void TearDownTestSuite() { delete pair_; }

  static cv::Mat image(const Frame& frame) {
    return {frame.height, frame.width, CV_8UC1, const_cast<std::uint8_t*>(frame.bytes.data())};
  }

  static inline synth::SyntheticPair* pair_ = nullptr;
};

TEST_F(OpenCvMatcher, DisparitiesAreFixedPointLikeThoseOfOpenCv) {
  const cv::Ptr<cv::StereoMatcher> matcher = opencv::StereoMatcher::create("fast");
  cv::Mat disparity;
  matcher->compute(image(pair_->left), image(pair_->right), disparity);
  ASSERT_EQ(disparity.type(), CV_16SC1);
  ASSERT_EQ(disparity.size(), cv::Size(pair_->left.width, pair_->left.height));
  int seen = 0, right = 0;
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      if (pair_->visible(u, v) == 0 || std::isnan(pair_->disparity(u, v))) continue;
      ++seen;
      right += std::abs(disparity.at<std::int16_t>(v, u) / 16.0 - pair_->disparity(u, v)) <= 0.5 ? 1 : 0;
    }
  }
  RecordProperty("within_half_a_pixel", std::to_string(static_cast<double>(right) / seen));
  EXPECT_GE(right, 0.9975 * seen);  // 0.998 measured
}

TEST_F(OpenCvMatcher, RoundsToSixteenthsAndMarksInvalid) {
  const auto matcher = opencv::StereoMatcher::create("fast", pair_->calibration);
  cv::Mat all, some;
  matcher->compute(image(pair_->left), image(pair_->right), all);
  const Image<float> disparity = matcher->result().disparity;
  EXPECT_EQ(matcher->find_damage().damages.size(),
            find_damage(matcher->result(), pair_->calibration, preset("fast").damage).damages.size());
  const int first = static_cast<int>(pair_->disparity(all.cols / 2, all.rows / 2)) - 2, count = 4;
  matcher->setMinDisparity(first);
  matcher->setNumDisparities(count);
  matcher->compute(image(pair_->left), image(pair_->right), some);
  const Image<float> again = matcher->result().disparity;
  int inside = 0;
  for (int v = 0; v < all.rows; ++v) {
    for (int u = 0; u < all.cols; ++u) {
      const auto fixed = [](float d) { return static_cast<int>(std::lround(d * 16)); };
      const int full = std::isnan(disparity(u, v)) ? -16 : fixed(disparity(u, v));
      ASSERT_EQ(all.at<std::int16_t>(v, u), full);
      const bool within =
          !std::isnan(again(u, v)) && fixed(again(u, v)) >= 16 * first && fixed(again(u, v)) < 16 * (first + count);
      ASSERT_EQ(some.at<std::int16_t>(v, u), within ? fixed(again(u, v)) : 16 * (first - 1));
      inside += within ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST_F(OpenCvMatcher, SpecklesAreInvalid) {
  const auto matcher = opencv::StereoMatcher::create("fast");
  matcher->setSpeckleWindowSize(pair_->left.width * pair_->left.height);  // every component is one
  cv::Mat disparity;
  matcher->compute(image(pair_->left), image(pair_->right), disparity);
  EXPECT_EQ(cv::countNonZero(disparity != -16), 0);
}

TEST(OpenCvMatcherProperties, AreThoseOfOptions) {
  const auto matcher = opencv::StereoMatcher::create(preset("paper"));
  EXPECT_EQ(matcher->getBlockSize(), 11);
  matcher->setBlockSize(7);
  EXPECT_EQ(matcher->getBlockSize(), 7);
  EXPECT_EQ(matcher->getDisp12MaxDiff(), 1);
  matcher->setDisp12MaxDiff(0);
  EXPECT_EQ(matcher->getDisp12MaxDiff(), -1);
  matcher->setDisp12MaxDiff(3);
  EXPECT_EQ(matcher->getDisp12MaxDiff(), 3);
  EXPECT_EQ(matcher->getMinDisparity(), 0);
  EXPECT_EQ(matcher->getNumDisparities(), 0);
  EXPECT_THROW(matcher->setBlockSize(4), Error);
  EXPECT_THROW(matcher->setBlockSize(41), Error);
  EXPECT_EQ(matcher->getBlockSize(), 7) << "an error changes nothing";
  EXPECT_THROW(matcher->setMinDisparity(4000), Error);
  EXPECT_THROW(matcher->setNumDisparities(-16), Error);
  EXPECT_THROW(opencv::StereoMatcher::create("slow"), Error);
  cv::Mat disparity;
  EXPECT_THROW(matcher->compute(cv::Mat(64, 64, CV_32FC1), cv::Mat(64, 64, CV_32FC1), disparity), Error);
}

}  // namespace
}  // namespace roadstereo

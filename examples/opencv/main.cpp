// disparity LEFT RIGHT OUTPUT: the disparities of a rectified pair by OpenCV's interface, as a 16-bit PNG (px · 256).
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <roadstereo/opencv.hpp>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: disparity LEFT RIGHT OUTPUT\n";
    return 2;
  }
  try {
    const cv::Mat left = cv::imread(argv[1], cv::IMREAD_UNCHANGED);
    const cv::Mat right = cv::imread(argv[2], cv::IMREAD_UNCHANGED);
    const cv::Ptr<cv::StereoMatcher> matcher = roadstereo::opencv::StereoMatcher::create("default");
    cv::Mat disparity, encoded;
    matcher->compute(left, right, disparity);
    disparity.convertTo(encoded, CV_16U, 16);  // from 1/16 px to 1/256 px; what is invalid becomes 0
    if (!cv::imwrite(argv[3], encoded)) return 1;
    std::cout << 100 * cv::countNonZero(encoded) / static_cast<int>(encoded.total()) << " % of the pixels are valid\n";
    return 0;
  } catch (const roadstereo::Error& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}

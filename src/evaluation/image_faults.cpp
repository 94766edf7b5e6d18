#include "evaluation/image_faults.hpp"

#include <opencv2/imgproc.hpp>

#include "io/frame_mat.hpp"

namespace roadstereo::io {
namespace {

/// The frame's samples, to be written to.
cv::Mat pixels_of(Frame& frame) {
  return {frame.height, frame.width, CV_8UC1, frame.bytes.data()};
}

/// Blend the frame towards `level` where the mask, 0 … 255, says so.
void blend(Frame& frame, const cv::Mat& mask, double level) {
  cv::Mat pixels = pixels_of(frame);
  for (int v = 0; v < pixels.rows; ++v) {
    for (int u = 0; u < pixels.cols; ++u) {
      const double share = mask.at<std::uint8_t>(v, u) / 255.0;
      auto& pixel = pixels.at<std::uint8_t>(v, u);
      pixel = cv::saturate_cast<std::uint8_t>((1 - share) * pixel + share * level);
    }
  }
}

cv::Point2d random_point(const Frame& frame, cv::RNG& random) {
  const double u = random.uniform(0.0, 1.0 * frame.width);
  return {u, random.uniform(0.0, 1.0 * frame.height)};
}

}  // namespace

void add_streaks(Frame& frame, int count, std::uint32_t seed) {
  constexpr double shift = 16;  // fixed point of cv::line
  cv::RNG random(seed);
  cv::Mat mask(frame.height, frame.width, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < count; ++i) {
    const cv::Point2d from = random_point(frame, random);
    const double length = random.uniform(20.0, 60.0), slope = random.uniform(-0.25, 0.25);
    const cv::Point2d to{from.x + slope * length, from.y + length};
    cv::line(mask, shift * from, shift * to, cv::Scalar(random.uniform(110, 220)), 1, cv::LINE_AA, 4);
  }
  blend(frame, mask, 255);
}

void add_dots(Frame& frame, int count, std::uint32_t seed) {
  constexpr double shift = 16;
  cv::RNG random(seed);
  cv::Mat mask(frame.height, frame.width, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < count; ++i) {
    const cv::Point2d at = random_point(frame, random);
    cv::circle(mask, shift * at, cvRound(shift * random.uniform(1.0, 3.0)), cv::Scalar(255), cv::FILLED, cv::LINE_AA,
               4);
  }
  blend(frame, mask, 250);
}

void add_specks(Frame& frame, int count, std::uint32_t seed) {
  cv::RNG random(seed);
  cv::Mat mask(frame.height, frame.width, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < count; ++i) {
    cv::circle(mask, random_point(frame, random), random.uniform(5, 10), cv::Scalar(200), cv::FILLED);
  }
  cv::GaussianBlur(mask, mask, {}, 1.5);
  blend(frame, mask, 20);
}

void add_dead_pixels(Frame& frame, double share, std::uint32_t seed) {
  cv::RNG random(seed);
  for (std::uint8_t& pixel : frame.bytes) {
    if (random.uniform(0.0, 1.0) < share) pixel = random.uniform(0, 2) == 0 ? 0 : 255;
  }
}

void scale_levels(Frame& frame, double gain) {
  cv::Mat pixels = pixels_of(frame);
  pixels.convertTo(pixels, -1, gain);
}

void add_noise(Frame& frame, double sigma_grey, std::uint32_t seed) {
  cv::RNG random(seed);
  for (std::uint8_t& pixel : frame.bytes) pixel = cv::saturate_cast<std::uint8_t>(pixel + random.gaussian(sigma_grey));
}

void blur(Frame& frame, double sigma_px) {
  cv::Mat pixels = pixels_of(frame);
  cv::GaussianBlur(pixels, pixels, {}, sigma_px);
}

Frame warped(const Frame& frame, const std::function<std::array<double, 2>(double u, double v)>& source) {
  cv::Mat along_u(frame.height, frame.width, CV_32FC1), along_v(frame.height, frame.width, CV_32FC1), result;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const auto [from_u, from_v] = source(u, v);
      along_u.at<float>(v, u) = static_cast<float>(from_u);
      along_v.at<float>(v, u) = static_cast<float>(from_v);
    }
  }
  cv::remap(mat_over(frame.view()), result, along_u, along_v, cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  return frame_from(result, ChannelOrder::grey);
}

}  // namespace roadstereo::io

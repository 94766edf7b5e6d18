#include "io/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "io/fixed_text.hpp"
#include "io/text_line.hpp"

namespace roadstereo::io {
namespace {

/// Blends the colour with opacity `cover`, 0 … 255, whose corner lies at `corner`.
void lay_colour(cv::Mat& picture, const cv::Mat& cover, cv::Point corner, const cv::Scalar& colour) {
  const cv::Rect visible = cv::Rect(corner, cover.size()) & cv::Rect(0, 0, picture.cols, picture.rows);
  const cv::Vec3d paint(colour[0], colour[1], colour[2]);
  for (int v = visible.y; v < visible.br().y; ++v) {
    for (int u = visible.x; u < visible.br().x; ++u) {
      auto& pixel = picture.at<cv::Vec3b>(v, u);
      const double share = cover.at<std::uint8_t>(v - corner.y, u - corner.x) / 255.0;
      pixel = cv::Vec3b(cv::Vec3d(pixel) * (1 - share) + paint * share);
    }
  }
}

}  // namespace

int text_height_for(int picture_height) {
  return std::clamp(8 + picture_height / 90, 9, 64);
}

int text_width(const std::string& text, int height) {
  return render_line(text, height).width;
}

void put_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
              Align align) {
  const TextLine line = render_line(text, height);
  if (align == Align::centre) at.x -= line.width / 2;
  if (align == Align::right) at.x -= line.width;
  lay_colour(picture, line.cover, at + line.origin, colour);
}

void put_haloed_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
                     const cv::Scalar& halo) {
  const TextLine line = render_line(text, height);
  if (line.cover.empty()) return;
  const int radius = std::max(1, height / 7);
  cv::Mat wide;
  cv::copyMakeBorder(line.cover, wide, radius, radius, radius, radius, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::dilate(wide, wide, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}));
  lay_colour(picture, wide, at + line.origin - cv::Point(radius, radius), halo);
  lay_colour(picture, line.cover, at + line.origin, colour);
}

void put_text_upwards(cv::Mat& picture, const std::string& text, cv::Point centre, int height, int max_length,
                      const cv::Scalar& colour) {
  const TextLine line = render_line(text, fitting_height(text, height, max_length));
  if (line.cover.empty()) return;
  cv::Mat upwards;
  cv::rotate(line.cover, upwards, cv::ROTATE_90_COUNTERCLOCKWISE);
  lay_colour(picture, upwards, {centre.x - upwards.cols / 2, centre.y - upwards.rows / 2}, colour);
}

int fitting_height(const std::string& text, int height, int max_length) {
  constexpr int min_height = 6;
  while (height > min_height && text_width(text, height) > max_length) --height;
  return height;
}

Ticks round_ticks(double lowest, double highest, int max_count) {
  const double span = highest - lowest;
  if (!(span > 0) || max_count < 1) return {{lowest}, 1};
  const int exponent = static_cast<int>(std::floor(std::log10(span / max_count)));
  double step = 0;
  int decimals = 0;
  for (int power = exponent; step == 0; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double candidate = digit * std::pow(10.0, power);
      const double count = std::floor(highest / candidate) - std::ceil(lowest / candidate) + 1;
      if (step == 0 && count <= max_count) {
        step = candidate;
        decimals = std::max(0, -power);
      }
    }
  }
  Ticks ticks{{}, decimals};
  const double first = std::ceil(lowest / step - 1e-9);
  for (int k = 0; k <= max_count && (first + k) * step <= highest + 1e-9 * span; ++k) {  // step may be below rounding
    ticks.values.push_back((first + k) * step);
  }
  return ticks;
}

std::string number_text(double value, int decimals) {
  std::string text = fixed_text(value, decimals);
  const bool is_minus_zero = text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos;
  return is_minus_zero ? text.substr(1) : text;
}

}  // namespace roadstereo::io

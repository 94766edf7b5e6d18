#include "io/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <utility>

namespace roadstereo::io {
namespace {

constexpr int font = cv::FONT_HERSHEY_SIMPLEX;

int thickness_for(int height) {
  return std::max(1, cvRound(height / 10.0));
}

double scale_for(int height) {
  return cv::getFontScaleFromHeight(font, height, thickness_for(height));
}

/// ASCII replacements of other characters.
std::string substitute(std::string_view character) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> known{
      {{"×", "x"}, {"–", "-"}, {"−", "-"}, {"…", "..."}, {"°", " deg"}, {"±", "+/-"}, {"’", "'"}, {"·", "."}}};
  for (const auto& [from, to] : known) {
    if (from == character) return std::string(to);
  }
  return "?";
}

std::string to_ascii(const std::string& text) {
  std::string ascii;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) ++end;
    const bool plain = end == at + 1 && text[at] >= ' ' && text[at] <= '~';
    ascii += plain ? text.substr(at, 1) : substitute(std::string_view(text).substr(at, end - at));
    at = end;
  }
  return ascii;
}

cv::Size text_size(const std::string& ascii, int height, int& below_base) {
  return cv::getTextSize(ascii, font, scale_for(height), thickness_for(height), &below_base);
}

}  // namespace

int text_height_for(int picture_height) {
  return std::clamp(8 + picture_height / 90, 9, 64);
}

int text_width(const std::string& text, int height) {
  int below_base = 0;
  return text_size(to_ascii(text), height, below_base).width;
}

void put_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
              Align align) {
  const std::string ascii = to_ascii(text);
  int below_base = 0;
  const int width = text_size(ascii, height, below_base).width;
  if (align == Align::centre) at.x -= width / 2;
  if (align == Align::right) at.x -= width;
  cv::putText(picture, ascii, at, font, scale_for(height), colour, thickness_for(height), cv::LINE_AA);
}

namespace {

/// Blends the colour with opacity `cover`, 0 … 255.
void lay_colour(cv::Mat picture, const cv::Mat& cover, const cv::Scalar& colour) {
  const cv::Vec3d paint(colour[0], colour[1], colour[2]);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      auto& pixel = picture.at<cv::Vec3b>(v, u);
      const double share = cover.at<std::uint8_t>(v, u) / 255.0;
      pixel = cv::Vec3b(cv::Vec3d(pixel) * (1 - share) + paint * share);
    }
  }
}

}  // namespace

void put_text_upwards(cv::Mat& picture, const std::string& text, cv::Point centre, int height, int max_length,
                      const cv::Scalar& colour) {
  const std::string ascii = to_ascii(text);
  const int fitting = fitting_height(ascii, height, max_length);
  int below_base = 0;
  const cv::Size size = text_size(ascii, fitting, below_base);
  const int margin = thickness_for(fitting) + 1;
  cv::Mat line(size.height + below_base + 2 * margin, size.width + 2 * margin, CV_8UC1, cv::Scalar(0));
  put_text(line, ascii, {margin, size.height + margin}, fitting, cv::Scalar(255));
  cv::rotate(line, line, cv::ROTATE_90_COUNTERCLOCKWISE);
  const cv::Rect wanted(centre.x - line.cols / 2, centre.y - line.rows / 2, line.cols, line.rows);
  const cv::Rect visible = wanted & cv::Rect(0, 0, picture.cols, picture.rows);
  if (visible.empty()) return;
  lay_colour(picture(visible), line(visible - wanted.tl()), colour);
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
  for (double i = first; i * step <= highest + 1e-9 * span; ++i) ticks.values.push_back(i * step);
  return ticks;
}

std::string number_text(double value, int decimals) {
  std::array<char, 64> text{};
  const double scale = std::pow(10.0, decimals);
  const double shown = std::round(value * scale) == 0 ? 0.0 : value;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, shown);
  return text.data();
}

}  // namespace roadstereo::io

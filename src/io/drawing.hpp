#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Foreground and background of all drawings, BGR.
inline const cv::Scalar paper{255, 255, 255};
inline const cv::Scalar ink{40, 40, 40};

enum class Align { left, centre, right };

/// Returns a readable height of capital letters, pixels, for an image of that height.
int text_height_for(int picture_height);

/// Returns the width of a line of text whose capitals are `height` pixels high.
int text_width(const std::string& text, int height);

/// Draws one line of text; `at` is the left end, middle or right end of its base line.
void put_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
              Align align = Align::left);

/// Draws one line of text from the left end of its base line, with a halo that sets it off from a picture.
void put_haloed_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
                     const cv::Scalar& halo);

/// Draws one line of text upwards, centred on `centre`; scaled down to `max_length`.
void put_text_upwards(cv::Mat& picture, const std::string& text, cv::Point centre, int height, int max_length,
                      const cv::Scalar& colour);

/// Returns the largest height up to `height` at which the line is at most `max_length` long.
int fitting_height(const std::string& text, int height, int max_length);

/// Returns at most `max_count` round numbers (spaced by 1, 2 or 5 times a power of ten) from `lowest` to `highest`.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks round_ticks(double lowest, double highest, int max_count);

/// Formats a number with that many decimals, without a minus before zero.
std::string number_text(double value, int decimals);

}  // namespace roadstereo::io
#pragma GCC visibility pop

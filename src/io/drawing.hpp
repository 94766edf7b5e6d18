#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roadstereo::io {

/// Ink and paper of every picture, BGR.
inline const cv::Scalar paper{255, 255, 255};
inline const cv::Scalar ink{40, 40, 40};

enum class Align { left, centre, right };

/// Height of capital letters, pixels, that reads well in a picture of that height.
int text_height_for(int picture_height);

/// Width of a line of text whose capitals are `height` pixels high.
int text_width(const std::string& text, int height);

/// Writes one line; `at` is the left end, middle or right end of its base line. Letters outside ASCII, which
/// OpenCV cannot draw, are replaced.
void put_text(cv::Mat& picture, const std::string& text, cv::Point at, int height, const cv::Scalar& colour,
              Align align = Align::left);

/// Writes one line reading upwards, centred on `centre`; made smaller when it is longer than `max_length`.
void put_text_upwards(cv::Mat& picture, const std::string& text, cv::Point centre, int height, int max_length,
                      const cv::Scalar& colour);

/// The largest height up to `height` at which the line is no longer than `max_length`.
int fitting_height(const std::string& text, int height, int max_length);

/// Round numbers (1, 2 or 5 times a power of ten apart) from `lowest` to `highest`, at most `most` of them.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks round_ticks(double lowest, double highest, int most);

/// A number with that many decimals, without a minus before zero.
std::string number_text(double value, int decimals);

}  // namespace roadstereo::io

#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "roadstereo/io/pictures.hpp"

namespace roadstereo::io {

// The parts that single pictures and the result sheet are put together from.

/// The given percentiles (0 … 100) of the valid values; empty when there are none.
std::vector<double> percentiles(ImageView<const float> map, std::initializer_list<double> shares);

/// The map in the scale's colours, without a bar; invalid pixels black.
cv::Mat colour_pixels(ImageView<const float> map, const ColourScale& scale);

/// Width of the scale bar with its numbers and label beside a picture of that height.
int scale_bar_width(const ColourScale& scale, int height, int text_height);

/// Draws the scale bar into `area` of the canvas.
void draw_scale_bar(cv::Mat& canvas, cv::Rect area, const ColourScale& scale, int text_height);

/// Draws the v-disparity histogram with its axes. The histogram's rows fill `plot` from top to bottom; tick
/// numbers and axis names lie left of it and below it.
void draw_v_disparity(cv::Mat& canvas, cv::Rect plot, ImageView<const float> disparity,
                      const std::optional<RollEstimate>& geometry, int text_height);

/// Room that the axes of draw_v_disparity need to the left of the plot and below it.
cv::Size v_disparity_margin(int image_height, int text_height);

}  // namespace roadstereo::io

#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "roadstereo/io/pictures.hpp"

namespace roadstereo::io {

// Parts of single images and of the result sheet.

/// Returns the given percentiles (0 … 100) of the valid values; empty if there are none.
std::vector<double> percentiles(ImageView<const float> map, std::initializer_list<double> shares);

/// Colours a map without a scale bar; invalid pixels black.
cv::Mat colour_pixels(ImageView<const float> map, const ColourScale& scale);

/// Returns the width of the scale bar with numbers and label for an image of that height.
int scale_bar_width(const ColourScale& scale, int height, int text_height);

/// Draws the scale bar into `area` of the canvas.
void draw_scale_bar(cv::Mat& canvas, cv::Rect area, const ColourScale& scale, int text_height);

/// Draws the v-disparity histogram (row against disparity, brighter = more pixels) with its axes and the fitted line
/// α0 + α1·y(ψ): the disparity of the road at the middle column of each row; dashed at the first and last column if
/// there is roll. The histogram fills `plot`; tick numbers and axis labels are at its left and below.
void draw_v_disparity(cv::Mat& canvas, cv::Rect plot, ImageView<const float> disparity,
                      const std::optional<RollEstimate>& geometry, int text_height);

/// Returns the margins of draw_v_disparity to the left of the plot and below it.
cv::Size v_disparity_margin(int image_height, int text_height);

}  // namespace roadstereo::io

#pragma once

#include <optional>
#include <string>

#include "roadstereo/image.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::io {

/// What a colour map shows.
struct ColourScale {
  double lowest = 0;       ///< value of the first colour
  double highest = 1;      ///< value of the last colour
  bool diverging = false;  ///< the middle is neutral: for values around a level
  std::string label;       ///< printed beside the scale bar, with the unit
};

/// Scale from the 1st to the 99th percentile of a map (for disparities).
ColourScale spread_scale(ImageView<const float> map, const std::string& label);

/// Symmetric scale around δt (for transformed maps): wide enough for 99.5 % of the values, but no wider than
/// 20 robust standard deviations of the road, so that vehicles and walls do not drown the damage; at least ±1
/// px.
ColourScale transformed_scale(ImageView<const float> transformed, double delta_t);

/// Colours a map, invalid pixels black, with a scale bar (ticks, numbers, label) to its right.
Frame colour_map(ImageView<const float> map, const ColourScale& scale);

/// The v-disparity histogram (row against disparity, brighter = more pixels) with the line α0 + α1·y(ψ)
/// fitted to it: the road's disparity at the middle column of each row, dashed at the first and last column
/// when there is roll.
Frame v_disparity_picture(ImageView<const float> disparity, const std::optional<RollEstimate>& geometry);

/// Four titled panels, two by two: left image, disparity, transformed disparity, v-disparity histogram.
Frame result_sheet(const FrameView& left, ImageView<const float> disparity, ImageView<const float> transformed,
                   double delta_t, const std::optional<RollEstimate>& geometry, const std::string& title);

}  // namespace roadstereo::io

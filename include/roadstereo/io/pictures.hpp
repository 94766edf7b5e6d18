#pragma once

#include <optional>
#include <string>

#include "roadstereo/image.hpp"
#include "roadstereo/roll.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Range and label of a colour map.
struct ColourScale {
  double lowest = 0;       ///< value of the first colour
  double highest = 1;      ///< value of the last colour
  bool diverging = false;  ///< neutral colour in the middle, for values around a level
  std::string label;       ///< printed beside the scale bar, with the unit
};

/// Returns the scale from the 1st to the 99th percentile of a map, e.g. of disparities.
ColourScale percentile_scale(ImageView<const float> map, const std::string& label);

/// Returns a symmetric scale around δt for transformed maps: covers 99.5 % of the values, but at most 20 robust
/// standard deviations of the road, so that vehicles and walls do not dominate; at least ±1 px.
ColourScale transformed_scale(ImageView<const float> transformed, double delta_t);

/// Colours a map, invalid pixels black, and adds a scale bar at its right.
Frame colour_map(ImageView<const float> map, const ColourScale& scale);

/// Draws four titled panels: left image (`white_level` as in to_grey), disparity, transformed disparity, v-disparity
/// histogram.
Frame result_sheet(const FrameView& left, double white_level, ImageView<const float> disparity,
                   ImageView<const float> transformed, double delta_t, const std::optional<RollEstimate>& geometry,
                   const std::string& title);

}  // namespace roadstereo::io
#pragma GCC visibility pop

#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Where a camera stands over the road of the roll experiments.
struct RollView {
  double height_m = 2.6;
  double pitch_deg = 60;
};

/// A road seen from there. `damaged` puts two potholes and a bump into the picture, off its middle, so that they pull
/// at the roll of whoever lets them.
synth::Scene roll_scene(const RollView& view, double roll_deg, bool damaged, double camber);

/// The exact disparities of a scene as a matcher would hand them on.
Image<float> exact_map(const synth::SyntheticPair& pair);

enum class Resampling { nearest, bilinear };

/// The map turned about the centre of the image, so that a road without roll gets the roll `roll_rad` of eqs. x, y.
/// What comes from outside the map is NaN.
Image<float> rotate_map(const Image<float>& map, double roll_rad, Resampling resampling);

/// Replaces `share` of the valid disparities, drawn at random, by uniform ones between 0 and the largest of the map.
/// The same seed spoils the same pixels on every machine.
void add_outliers(Image<float>& map, double share, std::uint64_t seed);

}  // namespace roadstereo::cli

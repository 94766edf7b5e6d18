#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Pose of the camera in the roll experiments.
struct RollView {
  double height_m = 2.6;
  double pitch_deg = 60;
};

/// Road seen from that pose. `damaged` adds two potholes and a bump off the middle of the image, so that they bias a
/// roll estimate that is not robust.
synth::Scene roll_scene(const RollView& view, double roll_deg, bool damaged, double camber);

enum class Resampling { nearest, bilinear };

/// Rotate a map about the centre of the image, so that a road without roll gets the roll `roll_rad` (eqs. (18), x, and
/// (19), y). Samples from outside the map are NaN.
Image<float> rotate_map(const Image<float>& map, double roll_rad, Resampling resampling);

/// Replace a random `share` of the valid disparities by uniform values between 0 and the maximum of the map. The result
/// for a seed is the same on every platform.
void add_outliers(Image<float>& map, double share, std::uint64_t seed);

}  // namespace roadstereo::cli

#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "roadstereo/image.hpp"

// Faults of one camera, painted into or warped out of an 8-bit grey frame.

namespace roadstereo::io {

/// Draw `count` thin bright streaks at random: rain.
void add_streaks(Frame& frame, int count, std::uint32_t seed);

/// Draw `count` white dots of radius 1 to 3 pixels at random: snow.
void add_dots(Frame& frame, int count, std::uint32_t seed);

/// Draw `count` dark blurred spots of radius 5 to 10 pixels at random: dirt on the lens.
void add_specks(Frame& frame, int count, std::uint32_t seed);

/// Set a share of the pixels, 0 … 1, to black or white at random.
void add_dead_pixels(Frame& frame, double share, std::uint32_t seed);

/// Scale the grey levels, clip them at white.
void scale_levels(Frame& frame, double gain);

/// Add Gaussian noise of that standard deviation, grey levels.
void add_noise(Frame& frame, double sigma_grey, std::uint32_t seed);

/// Blur with a Gaussian of that standard deviation, pixels.
void blur(Frame& frame, double sigma_px);

/// Warp with bicubic interpolation: pixel (u, v) shows what was at `source(u, v)`.
Frame warped(const Frame& frame, const std::function<std::array<double, 2>(double u, double v)>& source);

}  // namespace roadstereo::io

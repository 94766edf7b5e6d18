#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Reads PNG, JPEG, TIFF or PGM/PPM; 8 or 16 bit; grey or colour.
/// Throws Error naming the file if it is missing, unreadable, no image, not 8 or 16 bit, or not of 32×32 …
/// 8192×8192.
Frame read_frame(const std::string& path);

/// Returns the white level of a 16-bit pair whose camera has fewer than 16 bits: the smallest of 2^10−1, 2^12−1,
/// 2^14−1, 2^16−1 that no sample of either frame exceeds. 255 for 8-bit frames. Throws Error when the frames differ in
/// depth.
double find_white_level(const FrameView& left, const FrameView& right);

/// Reads a disparity map, pixels, NaN invalid: float TIFF or PFM (NaN, infinity and values beyond ±1e15, such as
/// −3.4e38, are invalid), or 16-bit PNG (value / 256, 0 is invalid). Throws Error naming the file if it is missing,
/// damaged or of another type.
Image<float> read_disparity(const std::string& path);

/// Encodes a float map as 32-bit TIFF, NaN kept.
std::vector<std::uint8_t> encode_float_tiff(ImageView<const float> map);

/// Encodes disparities as 16-bit KITTI PNG: value = round(256 d), 0 invalid. A disparity that rounds
/// to 0 is written as 1. Throws Error naming the first value outside 0 … 255.99 px.
std::vector<std::uint8_t> encode_kitti_png(ImageView<const float> disparity);

/// Encodes a frame (grey or colour, 8 or 16 bit) as PNG, samples unchanged. `compression`: 0 (none) … 9 (smallest).
std::vector<std::uint8_t> encode_png(const FrameView& frame, std::optional<int> compression = std::nullopt);

/// Encodes an 8-bit frame as JPEG, `quality` 1 … 100, and decodes it. Throws Error for another quality or depth.
Frame with_jpeg_loss(const Frame& frame, int quality);

}  // namespace roadstereo::io
#pragma GCC visibility pop

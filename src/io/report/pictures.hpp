#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "roadstereo/cross_section.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo::io {

/// Size limit of an image in a report.
struct PictureLimit {
  int side = 0;           ///< longest side, pixels
  std::size_t bytes = 0;  ///< of the file, approximate
};

/// Encodes an 8-bit BGR image as data URI: JPEG, or PNG if that is smaller. Downsampled and compressed to meet `limit`.
std::string picture_uri(const cv::Mat& picture, const PictureLimit& limit);

/// The same for an encoded image. Throws Error if it cannot be decoded.
std::string picture_uri(std::span<const std::uint8_t> encoded, const PictureLimit& limit);

/// Part of a frame around a damage, scaled by an integer factor.
struct Crop {
  PixelBox box;
  cv::Size size;          ///< pixels of the scaled image
  std::size_t bytes = 0;  ///< of the file, approximate
};
Crop crop_around(const DamageMap& map, const Damage& damage, const PictureLimit& limit);

/// Returns the crop of the image with the outline of the damage as SVG.
std::string crop_svg(const cv::Mat& picture, const DamageMap& map, const Damage& damage, const Crop& crop);

/// Marks on the depth image.
struct DepthMarks {
  ImageView<const float> holes;           ///< NaN is hatched
  const CrossSection* section = nullptr;  ///< may be null
  double max_depth = 1;                   ///< end of the colour scale
};

/// Returns the crop of the depths with outline and marks as SVG.
std::string depth_svg(const DamageMap& map, const Damage& damage, const Crop& crop, const DepthMarks& marks);

/// Returns the colour scale from −max_depth (above the road, top) to max_depth as an image one pixel wide.
cv::Mat depth_ramp(int steps);

}  // namespace roadstereo::io

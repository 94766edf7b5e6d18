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
  std::string id;         ///< shown number of the damage
  double gsd_m = 0;       ///< along the rows at the damage, metres per pixel of the frame; 0: unknown
};
/// `focal_px` 0: unknown.
Crop crop_around(const DamageMap& map, const Damage& damage, const PictureLimit& limit, double focal_px);

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

/// Returns the colours of the depths for the scripts as JSON, from above the road to below it.
std::string depth_palette_json();

/// Returns the colour scale of the depths, above the road at the top, as a CSS custom property.
std::string depth_colours();

}  // namespace roadstereo::io

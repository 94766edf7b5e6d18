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

/// How large a picture in a report may be.
struct PictureLimit {
  int side = 0;           ///< longest side, pixels
  std::size_t bytes = 0;  ///< of its file, about
};

/// An 8-bit BGR picture as the source of an image: JPEG, or PNG where that is smaller. Shrunk to the limit's side, and
/// compressed or shrunk more until it keeps to its bytes.
std::string picture_uri(const cv::Mat& picture, const PictureLimit& limit);

/// The same of an encoded picture. Throws Error when it is none.
std::string picture_uri(std::span<const std::uint8_t> encoded, const PictureLimit& limit);

/// The part of a frame that shows a damage, scaled as a whole so that drawings on it stay small.
struct Crop {
  PixelBox box;
  cv::Size size;          ///< pixels of the scaled picture
  std::size_t bytes = 0;  ///< of its file, about
};
Crop crop_around(const DamageMap& map, const Damage& damage, const PictureLimit& limit);

/// The crop of the picture with the damage's outline, as SVG.
std::string crop_svg(const cv::Mat& picture, const DamageMap& map, const Damage& damage, const Crop& crop);

/// What the picture of depths shows besides them.
struct DepthMarks {
  ImageView<const float> holes;           ///< its NaN are hatched
  const CrossSection* section = nullptr;  ///< its line is drawn
  double reach = 1;                       ///< depth of the last colour
};

/// The crop of the depths with outline and marks, as SVG.
std::string depth_svg(const DamageMap& map, const Damage& damage, const Crop& crop, const DepthMarks& marks);

/// The colours of depths from −reach (above the road) to reach as a picture one pixel wide, top to bottom.
cv::Mat depth_ramp(int steps);

}  // namespace roadstereo::io

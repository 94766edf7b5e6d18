#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Grey level and its gradient between pixels: 8-bit grey levels, and per pixel of the level.
struct GreySample {
  float grey = 0;
  float per_column = 0;
  float per_row = 0;
};

/// Bilinear, of central differences; false outside.
bool sample_grey(ImageView<const std::int16_t> level, double x, double y, GreySample& sample);

}  // namespace roadstereo

#pragma GCC visibility push(default)
namespace roadstereo {

/// 8-bit grey levels per unit of an image of sixteenths.
inline constexpr float grey_unit = 1.0F / 16;

/// Gaussian-like pyramid of an image: level 0 is the image, every further level is the mean of 2×2 pixels of the one
/// before. Pixel (x, y) of level n has its centre at ((x + ½)·2ⁿ − ½, …) of the image. Sixteenths of grey levels.
class ImagePyramid {
 public:
  ImagePyramid() = default;
  ImagePyramid(const ImagePyramid&) = delete;
  ImagePyramid& operator=(const ImagePyramid&) = delete;

  /// The image must outlive the use of level 0. Keeps the memory of the last image.
  void build(ImageView<const std::int16_t> grey);

  int levels() const { return static_cast<int>(reduced_.size()) + 1; }
  ImageView<const std::int16_t> level(int n) const {
    return n == 0 ? grey_ : reduced_[static_cast<std::size_t>(n - 1)].view();
  }

 private:
  ImageView<const std::int16_t> grey_;
  std::vector<GreyImage> reduced_;  ///< levels from 1
};

}  // namespace roadstereo
#pragma GCC visibility pop

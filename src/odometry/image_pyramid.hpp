#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Grey level and its gradient at a pixel: 8-bit grey levels, and per pixel of the level.
struct GreySample {
  float grey = 0;
  float per_column = 0;
  float per_row = 0;
};

/// Gaussian-like pyramid of an image: level 0 has its size, every further level is the mean of 2×2 pixels of the one
/// before. Pixel (x, y) of level n has its centre at ((x + ½)·2ⁿ − ½, …) of the image.
class ImagePyramid {
 public:
  /// Keeps the memory of the last image.
  void build(ImageView<const std::int16_t> grey);

  int levels() const { return levels_; }
  const Image<GreySample>& level(int n) const { return samples_[static_cast<std::size_t>(n)]; }

 private:
  int levels_ = 0;
  std::vector<GreyImage> grey_;  ///< of the levels above 0
  std::vector<Image<GreySample>> samples_;
};

}  // namespace roadstereo
#pragma GCC visibility pop

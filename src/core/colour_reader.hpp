#pragma once

#include <array>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Red, green and blue of an image of any order and depth, 0 … 255. `white_level` as in to_grey.
class ColourReader {
 public:
  ColourReader(const FrameView& image, double white_level);

  std::array<float, 3> pixel(int u, int v) const;
  /// Bilinear between pixels.
  std::array<float, 3> at(double u, double v) const;

 private:
  FrameView image_;
  float scale_ = 1;
};

}  // namespace roadstereo
#pragma GCC visibility pop

#pragma once

#include <cstdint>

namespace roadstereo {

/// Contents of an image, as far as they make a pair invalid.
struct ImageContents {
  bool has_contrast = true;  ///< false: every pixel has one grey level
  std::int16_t first = 0;    ///< level of the first pixel, in sixteenths
};

struct PairContents {
  ImageContents left, right;
  bool equal = false;  ///< the images are the same
};

/// Throws Error for an invalid pair.
void require_pair(const PairContents& contents);

}  // namespace roadstereo

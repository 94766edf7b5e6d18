#pragma once

#include <cstdint>

namespace roadstereo {

/// What an image shows, as far as a pair must be refused for it.
struct ImageContents {
  bool something = true;   ///< false: every pixel has one grey level
  std::int16_t first = 0;  ///< that of the first pixel, in sixteenths
};

struct PairContents {
  ImageContents left, right;
  bool equal = false;  ///< the images are the same
};

/// Throws Error for a pair that cannot be one.
void require_pair(const PairContents& contents);

}  // namespace roadstereo

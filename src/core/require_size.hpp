#pragma once

#include "roadstereo/error.hpp"

namespace roadstereo {

struct ImageSize {
  int width = 0, height = 0;

  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Returns the size of an image or a map, pixels.
template <class Map>
ImageSize map_size(const Map& map) {
  return {map.width(), map.height()};
}

/// Throws Error unless both have one size. The names begin with an article: "the disparity map".
inline void require_same_size(const char* name, const ImageSize& size, const char* other_name, const ImageSize& other) {
  if (size == other) return;
  fail(name, " has ", size.width, "×", size.height, " pixels and ", other_name, " ", other.width, "×", other.height,
       "; they must have the same size");
}

inline void require_one_size(const ImageSize& left, const ImageSize& right) {
  if (left == right) return;
  fail("the left image has ", left.width, "×", left.height, " pixels and the right image ", right.width, "×",
       right.height, "; a pair must have one size");
}

/// 32×32 … 8192×8192 pixels.
void require_image_size(int width, int height);

/// A mask may be empty.
inline void require_mask_size(const ImageSize& mask, const ImageSize& pair) {
  if (mask.width == 0 || mask.height == 0 || mask == pair) return;
  fail("the mask has ", mask.width, "×", mask.height, " pixels; it must have ", pair.width, "×", pair.height,
       " like the pair");
}

}  // namespace roadstereo

#pragma once

#include <cstdint>

#include "core/scratch.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Blocks of a downsampled image that contain a masked pixel, by a summed-area table of the mask.
class MaskedBlocks {
 public:
  /// No pixel is masked.
  MaskedBlocks() = default;
  /// `mask` (full size, not 0 masked) may be empty: then no pixel is masked.
  MaskedBlocks(ImageView<const std::uint8_t> mask, int factor);

  /// Whether the block around pixel (u, v) of the downsampled image, inside it, contains a masked pixel.
  bool contains(int u, int v, int half_width, int half_height) const {
    if (sums_.empty()) return false;
    const std::int32_t* top = row(v - half_height);
    const std::int32_t* bottom = row(v + half_height + 1);
    const int first = u - half_width, last = u + half_width + 1;
    return bottom[last] - bottom[first] - top[last] + top[first] > 0;
  }

 private:
  const std::int32_t* row(int v) const { return sums_.data() + static_cast<std::ptrdiff_t>(v) * (width_ + 1); }

  int width_ = 0;
  ScratchVector<std::int32_t> sums_ = scratch_vector<std::int32_t>();  ///< masked pixels above and left of a corner
};

}  // namespace roadstereo

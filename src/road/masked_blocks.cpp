#include "road/masked_blocks.hpp"

#include <algorithm>

namespace roadstereo {

MaskedBlocks::MaskedBlocks(ImageView<const std::uint8_t> mask, int factor) : width_(mask.width() / factor) {
  if (mask.empty()) return;
  const int height = mask.height() / factor;
  sums_.resize(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height + 1));
  for (int v = 0; v < height; ++v) {
    std::int32_t* sums = sums_.data() + static_cast<std::ptrdiff_t>(v + 1) * (width_ + 1);
    std::int32_t of_row = 0;
    for (int u = 0; u < width_; ++u) {
      for (int y = v * factor; y < (v + 1) * factor; ++y) {
        const std::uint8_t* pixels = mask.row(y) + std::ptrdiff_t{u} * factor;
        of_row +=
            static_cast<std::int32_t>(std::count_if(pixels, pixels + factor, [](auto value) { return value != 0; }));
      }
      sums[u + 1] = row(v)[u + 1] + of_row;
    }
  }
}

}  // namespace roadstereo

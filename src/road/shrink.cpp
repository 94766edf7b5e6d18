#include "road/shrink.hpp"

#include <cstdint>
#include <vector>

namespace roadstereo {

GreyImage shrink(ImageView<const std::int16_t> image, int factor) {
  const int width = image.width() / factor;
  const int height = image.height() / factor;
  GreyImage small(width, height);
  std::vector<std::int32_t> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(factor));
  for (int y = 0; y < height; ++y) {
    std::fill(sums.begin(), sums.end(), 0);
    for (int r = 0; r < factor; ++r) {
      const std::int16_t* row = image.row(y * factor + r);
      for (std::size_t u = 0; u < sums.size(); ++u) sums[u] += row[u];
    }
    for (int x = 0; x < width; ++x) {
      std::int32_t sum = 0;
      for (int c = 0; c < factor; ++c) sum += sums[static_cast<std::size_t>(x * factor + c)];
      small(x, y) = static_cast<std::int16_t>(sum / (factor * factor));
    }
  }
  return small;
}

}  // namespace roadstereo

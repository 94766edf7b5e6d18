#include "road/shrink.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace roadstereo {

GreyImage shrink(ImageView<const std::int16_t> image, int factor) {
  const int width = image.width() / factor;
  const int height = image.height() / factor;
  GreyImage small(width, height);
  if (factor == 1) {
    for (int y = 0; y < height; ++y) std::copy_n(image.row(y), width, small.row(y));
    return small;
  }
  std::vector<std::int32_t> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(factor));
  for (int y = 0; y < height; ++y) {
    std::fill(sums.begin(), sums.end(), 0);
    for (int r = 0; r < factor; ++r) {
      const std::int16_t* row = image.row(y * factor + r);
      for (std::size_t u = 0; u < sums.size(); ++u) sums[u] += row[u];
    }
    for (int x = 0; x < width; ++x) {
      const auto first = sums.begin() + static_cast<std::ptrdiff_t>(x) * factor;
      small(x, y) = static_cast<std::int16_t>(std::accumulate(first, first + factor, 0) / (factor * factor));
    }
  }
  return small;
}

}  // namespace roadstereo

#include "evaluate/common_pixels.hpp"

#include <cmath>

#include "evaluate/methods.hpp"

namespace roadstereo::cli {

Image<std::uint8_t> common_pixels(const std::vector<Image<float>>& maps,
                                  const std::optional<ImageView<const std::uint8_t>>& mask) {
  const std::size_t sparse = method_index("BM");
  Image<std::uint8_t> common(maps.front().width(), maps.front().height(), 255);
  for (int v = 0; v < common.height(); ++v) {
    for (int u = 0; u < common.width(); ++u) {
      if (mask && (*mask)(u, v) == 0) common(u, v) = 0;
      for (std::size_t i = 0; i < maps.size(); ++i) {
        if (i != sparse && std::isnan(maps[i](u, v))) common(u, v) = 0;
      }
    }
  }
  return common;
}

}  // namespace roadstereo::cli

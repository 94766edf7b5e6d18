#include "evaluate/error_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadstereo::cli {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Image<float> absolute_error(ImageView<const float> map, ImageView<const float> truth,
                            const std::optional<ImageView<const std::uint8_t>>& mask) {
  Image<float> errors(map.width(), map.height(), nothing);
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (mask && (*mask)(u, v) == 0) continue;
      const float error = std::abs(map(u, v) - truth(u, v));
      if (std::isfinite(error)) errors(u, v) = error;
    }
  }
  return errors;
}

Image<float> thicken(ImageView<const float> map, int radius) {
  Image<float> thick(map.width(), map.height(), nothing);
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (!std::isfinite(map(u, v))) continue;
      for (int y = std::max(0, v - radius); y <= std::min(map.height() - 1, v + radius); ++y) {
        for (int x = std::max(0, u - radius); x <= std::min(map.width() - 1, u + radius); ++x) {
          thick(x, y) = std::fmax(thick(x, y), map(u, v));  // the number when the other is NaN
        }
      }
    }
  }
  return thick;
}

}  // namespace roadstereo::cli

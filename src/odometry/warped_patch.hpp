#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "odometry/reference_points.hpp"

namespace roadstereo {

/// Patch as the current camera sees it: grey levels less their mean, of length 1.
class WarpedPatch {
 public:
  static constexpr int radius = 3;
  static constexpr int side = 2 * radius + 1;

  /// False where the view differs too much, or without texture.
  bool warp(const TexturePatch& patch, const std::array<double, 4>& jacobian) {
    const double determinant = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2];
    constexpr double min_scale = 0.2, max_scale = 5;  // of areas
    if (!(determinant > min_scale && determinant < max_scale)) return false;
    constexpr float count = side * side;
    float sum = 0, squares = 0;
    std::size_t i = 0;
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        grey_[i] = sample(patch, (jacobian[3] * x - jacobian[1] * y) / determinant,
                          (jacobian[0] * y - jacobian[2] * x) / determinant);
        sum += grey_[i++];
      }
    }
    for (float& grey : grey_) {
      grey -= sum / count;
      squares += grey * grey;
    }
    if (!(squares > count * min_variance)) return false;
    for (float& grey : grey_) grey /= std::sqrt(squares);
    return true;
  }

  /// NCC around a pixel; −1 without texture.
  float correlate(ImageView<const std::int16_t> image, int u, int v) const {
    constexpr float count = side * side;
    float sum = 0, squares = 0, products = 0;
    const float* grey = grey_.data();
    for (int y = v - radius; y <= v + radius; ++y) {
      const std::int16_t* row = image.row(y) + u - radius;
      for (int x = 0; x < side; ++x) {
        const float level = static_cast<float>(row[x]) * grey_unit;
        sum += level;
        squares += level * level;
        products += level * *grey++;
      }
    }
    const float variance = squares - sum * sum / count;
    return variance > count * min_variance ? products / std::sqrt(variance) : -1;
  }

 private:
  static constexpr float min_variance = 0.1F;  // grey levels²: that of rounding to 8 bits

  static float sample(const TexturePatch& patch, double x, double y) {
    constexpr double last = 2 * TexturePatch::radius - 1e-3;
    const double column = std::clamp(x + TexturePatch::radius, 0.0, last),
                 row = std::clamp(y + TexturePatch::radius, 0.0, last);
    const int u = static_cast<int>(column), v = static_cast<int>(row);
    const float fu = static_cast<float>(column - u), fv = static_cast<float>(row - v);
    const float* at = patch.grey.data() + std::ptrdiff_t{v} * TexturePatch::side + u;
    const float above = at[0] + fu * (at[1] - at[0]);
    const float below = at[TexturePatch::side] + fu * (at[TexturePatch::side + 1] - at[TexturePatch::side]);
    return above + fv * (below - above);
  }

  std::array<float, std::size_t{side} * side> grey_{};
};

}  // namespace roadstereo

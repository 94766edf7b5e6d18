#include "evaluation/sub_pixel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/require_size.hpp"

namespace roadstereo {
namespace {

/// Sums over boxes, and numbers of their valid pixels.
class BoxSums {
 public:
  explicit BoxSums(ImageView<const float> values) : stride_(static_cast<std::size_t>(values.width()) + 1) {
    sums_.resize(stride_ * (static_cast<std::size_t>(values.height()) + 1));
    counts_.resize(sums_.size());
    for (int v = 0; v < values.height(); ++v) {
      for (int u = 0; u < values.width(); ++u) {
        const bool valid = std::isfinite(values(u, v));
        add(sums_, u, v, valid ? static_cast<double>(values(u, v)) : 0);
        add(counts_, u, v, valid ? 1 : 0);
      }
    }
  }

  /// Sum over the square around (u, v), as if its invalid pixels were like the valid ones.
  double around(int u, int v, int radius) const {
    const int first_u = u - radius, first_v = v - radius, end_u = u + radius + 1, end_v = v + radius + 1;
    const double area = static_cast<double>(2 * radius + 1) * (2 * radius + 1);
    return box(sums_, first_u, first_v, end_u, end_v) * area / box(counts_, first_u, first_v, end_u, end_v);
  }

 private:
  void add(std::vector<double>& integral, int u, int v, double value) const {
    integral[at(u + 1, v + 1)] = integral[at(u + 1, v)] + integral[at(u, v + 1)] - integral[at(u, v)] + value;
  }
  std::size_t at(int u, int v) const { return static_cast<std::size_t>(v) * stride_ + static_cast<std::size_t>(u); }
  double box(const std::vector<double>& integral, int first_u, int first_v, int end_u, int end_v) const {
    return integral[at(end_u, end_v)] - integral[at(first_u, end_v)] - integral[at(end_u, first_v)] +
           integral[at(first_u, first_v)];
  }

  std::size_t stride_;
  std::vector<double> sums_, counts_;
};

}  // namespace

void SubPixelNoise::add(ImageView<const float> first, ImageView<const float> second, ImageView<const float> derivative,
                        ImageView<const std::uint8_t> mask, double noise_grey) {
  require_same_size("the first map", map_size(first), "the second map", map_size(second));
  require_same_size("the first map", map_size(first), "the derivative", map_size(derivative));
  require_same_size("the first map", map_size(first), "the mask", map_size(mask));
  constexpr float max_difference_px = 1;  // larger ones are mismatches
  Image<float> errors(first.width(), first.height());
  for (int v = 0; v < first.height(); ++v) {
    for (int u = 0; u < first.width(); ++u) {
      const float difference = first(u, v) - second(u, v);
      const bool is_match = std::abs(difference) <= max_difference_px;  // false for NaN
      errors(u, v) = is_match ? difference / std::sqrt(2.0F) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  const BoxSums sums(errors);
  for (int v = max_distance_px; v < first.height() - max_distance_px; ++v) {
    for (int u = max_distance_px; u < first.width() - max_distance_px; ++u) {
      const double error = errors(u, v), gradient = derivative(u, v);
      if (mask(u, v) == 0 || !std::isfinite(error)) continue;
      pixels_ += 1;
      squares_ += error * error;
      products_ += error * sums.around(u, v, max_distance_px);
      information_ += gradient * gradient / (2 * noise_grey * noise_grey);
    }
  }
}

double SubPixelNoise::noise_px() const {
  return std::sqrt(squares_ / pixels_);
}

double SubPixelNoise::support_px() const {
  return std::sqrt(std::max(0.0, products_ / squares_));
}

double SubPixelNoise::bound_px() const {
  return 1 / std::sqrt(support_px() * support_px() * information_ / pixels_);
}

double SubPixelNoise::ratio() const {
  return noise_px() / bound_px();
}

}  // namespace roadstereo

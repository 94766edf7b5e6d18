#include "pipeline/picture_health.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/order_statistics.hpp"

namespace roadstereo {
namespace {

using Grey = ImageView<const std::int16_t>;

/// Pixel of the right image nearest to what the left one has at a pixel.
struct Match {
  int u = 0, v = 0;
  double off_px = 0;  ///< distance to the place itself, the larger of both directions
};

/// Nothing where there is no disparity or fewer than `margin` pixels lie around the match.
std::optional<Match> match_of(const FrameResult& frame, int u, int v, int margin) {
  const double disparity = frame.disparity(u, v);
  if (std::isnan(disparity)) return std::nullopt;
  const Misalignment& misalignment = frame.shift.misalignment;
  const double x = u - disparity, column = x + misalignment.columns_at(v), row = v + misalignment.rows_at(x, v);
  const Match match{static_cast<int>(std::lround(column)), static_cast<int>(std::lround(row)),
                    std::max(std::abs(column - std::round(column)), std::abs(row - std::round(row)))};
  const bool inside = match.u >= margin && match.u + margin < frame.right.width() && match.v >= margin &&
                      match.v + margin < frame.right.height();
  return inside ? std::optional(match) : std::nullopt;
}

/// Share of the road's pixels in each view that are black or white, and the ratio of the levels of the others.
void measure_exposure(const FrameResult& frame, const DamageMap& damage, PairHealth& health) {
  constexpr int step = 3;
  constexpr std::size_t min_pixels = 100;
  const auto is_clipped = [](int level) { return level <= 0 || level >= grey_max; };
  std::vector<float> ratios;
  std::size_t pixels = 0, left_clipped = 0, right_clipped = 0;
  for (int v = 0; v < frame.grey.height(); v += step) {
    for (int u = 0; u < frame.grey.width(); u += step) {
      const std::optional<Match> match = match_of(frame, u, v, 0);
      if (damage.road(u, v) == 0 || !match) continue;
      const int left = frame.grey(u, v), right = frame.right(match->u, match->v);
      ++pixels;
      left_clipped += is_clipped(left) ? 1U : 0U;
      right_clipped += is_clipped(right) ? 1U : 0U;
      if (is_clipped(left) || is_clipped(right)) continue;
      ratios.push_back(static_cast<float>(right) / static_cast<float>(left));
    }
  }
  if (pixels < min_pixels) return;
  health.clipped_left = static_cast<double>(left_clipped) / static_cast<double>(pixels);
  health.clipped_right = static_cast<double>(right_clipped) / static_cast<double>(pixels);
  if (ratios.size() >= min_pixels) health.gain = static_cast<double>(upper_median(ratios));
}

/// Mean square of the differences of pixels `lag` apart, along rows and columns, over the road.
double structure_function(Grey image, const DamageMap& damage, int lag, bool down) {
  constexpr int step = 2;
  double sum = 0, count = 0;
  const int du = down ? 0 : lag, dv = down ? lag : 0;
  for (int v = 0; v + dv < image.height(); v += step) {
    for (int u = 0; u + du < image.width(); u += step) {
      if (damage.road(u, v) == 0 || damage.road(u + du, v + dv) == 0) continue;
      const double difference = image(u + du, v + dv) - image(u, v);
      sum += difference * difference;
      ++count;
    }
  }
  constexpr double min_count = 100;
  return count >= min_count ? sum / count : PairHealth::unknown;
}

/// Gaussian blur σ of white texture whose structure function, 1 − exp(−lag² / 4σ²), has that ratio at the two lags.
double blur_of_ratio(double ratio, double near, double far) {
  constexpr double min_px = 0.3, max_px = 12;
  double low = min_px, high = max_px;
  constexpr int bisections = 30;
  for (int i = 0; i < bisections; ++i) {
    const double sigma = 0.5 * (low + high), scale = 1 / (4 * sigma * sigma);
    const double expected = -std::expm1(-near * near * scale) / -std::expm1(-far * far * scale);
    (expected > ratio ? low : high) = sigma;
  }
  return 0.5 * (low + high);
}

/// The larger blur of the two directions.
double blur_of(Grey image, const DamageMap& damage) {
  constexpr int near = 2, far = 12;
  double blur = 0;
  for (const bool down : {false, true}) {
    const double ratio = structure_function(image, damage, near, down) / structure_function(image, damage, far, down);
    if (std::isnan(ratio)) return PairHealth::unknown;
    blur = std::max(blur, blur_of_ratio(ratio, near, far));
  }
  return blur;
}

/// Immerkær's mask, which takes away planes of grey levels; its coefficients squared sum to 36.
int noise_mask(Grey image, int u, int v) {
  const auto second_difference = [&](int row) { return image(u - 1, row) - 2 * image(u, row) + image(u + 1, row); };
  return second_difference(v - 1) - 2 * second_difference(v) + second_difference(v + 1);
}

double block_variance(Grey image, int at_u, int at_v, int radius) {
  double sum = 0, squares = 0, pixels = 0;
  for (int v = at_v - radius; v <= at_v + radius; ++v) {
    for (int u = at_u - radius; u <= at_u + radius; ++u, ++pixels) {
      const double level = image(u, v);
      sum += level;
      squares += level * level;
    }
  }
  return (squares - sum * sum / pixels) / (pixels - 1);
}

/// Variance of the white noise of a view by the median variance of blocks of the road. Noise is what the mask responds
/// to differently in both views, where matches are nearly whole pixels: fine texture is the same in both.
double noise_share(const FrameResult& frame, const DamageMap& damage) {
  constexpr int radius = 3, step = 3;
  constexpr double mask_norm = 6, max_fraction_px = 0.25;
  constexpr std::size_t min_blocks = 100;
  std::vector<float> differences, variances;
  for (int v = radius; v + radius < frame.grey.height(); v += step) {
    for (int u = radius; u + radius < frame.grey.width(); u += step) {
      const std::optional<Match> match = match_of(frame, u, v, 1);
      if (damage.road(u, v) == 0 || !match || match->off_px > max_fraction_px) continue;
      differences.push_back(
          static_cast<float>(noise_mask(frame.grey, u, v) - noise_mask(frame.right, match->u, match->v)));
      variances.push_back(static_cast<float>(block_variance(frame.grey, u, v, radius)));
    }
  }
  if (variances.size() < min_blocks) return PairHealth::unknown;
  const double noise = gaussian_mad * upper_median_magnitude(differences) / mask_norm;
  const double variance = upper_median(variances);
  return variance > 0 ? 0.5 * noise * noise / variance : PairHealth::unknown;
}

/// Excess of the steps at multiples of 8 pixels over those beside them, relative: JPEG quantises blocks of 8×8 apart.
double block_excess(Grey image) {
  constexpr int block = 8;
  std::array<double, block> steps{};
  for (int v = 1; v < image.height(); ++v) {
    const std::int16_t *above = image.row(v - 1), *row = image.row(v);
    for (int u = 1; u < image.width(); ++u) {
      steps[static_cast<std::size_t>(u % block)] += std::abs(row[u] - row[u - 1]);
      steps[static_cast<std::size_t>(v % block)] += std::abs(row[u] - above[u]);
    }
  }
  const double beside = 0.5 * (steps[1] + steps[block - 1]);
  return beside > 0 ? steps[0] / beside - 1 : PairHealth::unknown;
}

}  // namespace

void measure_pictures(const FrameResult& frame, const DamageMap& damage, PairHealth& health) {
  measure_exposure(frame, damage, health);
  health.blur_left_px = blur_of(frame.grey, damage);
  health.blur_right_px = blur_of(frame.right, damage);
  health.noise_share = noise_share(frame, damage);
  health.blocks_left = block_excess(frame.grey);
  health.blocks_right = block_excess(frame.right);
}

}  // namespace roadstereo

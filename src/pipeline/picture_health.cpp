#include "pipeline/picture_health.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/block_grid.hpp"
#include "core/deblocking.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "pipeline/stripe_noise.hpp"

namespace roadstereo {
namespace {

using Grey = ImageView<const std::int16_t>;

/// Calls `visit(u, v)` for some ten thousand places of an image, at least 3 pixels apart and `margin` from its border.
/// A row of them is shifted by a pixel against the last, so that no pattern falls on all or none.
template <class Visit>
void for_each_sample(Grey image, int margin, Visit&& visit) {
  constexpr int min_step = 3;
  constexpr double samples = 10e3;
  const int step =
      std::max(min_step, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(image.pixels()) / samples))));
  for (int v = margin, shift = 0; v + margin < image.height(); v += step, shift = (shift + 1) % step) {
    for (int u = margin + shift; u + margin < image.width(); u += step) visit(u, v);
  }
}

/// Pixel of the right image nearest to what the left one has at a pixel.
struct Match {
  int u = 0, v = 0;
  double off_px = 0;  ///< distance to the place itself, the larger of both directions
};

/// Nothing off the road, without a disparity, and where fewer than `margin` pixels lie around the match.
std::optional<Match> match_of(const FrameResult& frame, const DamageMap& damage, int u, int v, int margin) {
  const double bias = frame.rig_bias ? frame.rig_bias->at(u, v) : 0, disparity = frame.disparity(u, v) + bias;
  if (damage.road(u, v) == 0 || std::isnan(disparity)) return std::nullopt;
  const Misalignment& misalignment = frame.shift.misalignment;
  const double x = u - disparity, column = x + misalignment.columns_at(v), row = v + misalignment.rows_at(x, v);
  const auto inside = [margin](double at, int size) { return at >= margin - 0.5 && at < size - margin - 0.5; };
  if (!inside(column, frame.right.width()) || !inside(row, frame.right.height())) return std::nullopt;
  const int at_u = static_cast<int>(column + 0.5), at_v = static_cast<int>(row + 0.5);  // NOLINT: not negative
  return Match{at_u, at_v, std::max(std::abs(column - at_u), std::abs(row - at_v))};
}

/// Share of the road's pixels in each view that are black or white, and the ratio of the levels of the others.
void measure_exposure(const FrameResult& frame, const DamageMap& damage, PairHealth& health) {
  constexpr std::size_t min_pixels = 100;
  constexpr int white = grey_max - grey_scale / 4;  // of 10 bits or more, shifted to 16
  const auto is_clipped = [](int level) { return level <= 0 || level >= white; };
  std::vector<float> ratios;
  std::size_t pixels = 0, left_clipped = 0, right_clipped = 0;
  for_each_sample(frame.grey, 0, [&](int u, int v) {
    const std::optional<Match> match = match_of(frame, damage, u, v, 0);
    if (!match) return;
    const int left = frame.grey(u, v), right = frame.right(match->u, match->v);
    ++pixels;
    left_clipped += is_clipped(left) ? 1U : 0U;
    right_clipped += is_clipped(right) ? 1U : 0U;
    if (is_clipped(left) || is_clipped(right)) return;
    ratios.push_back(static_cast<float>(right) / static_cast<float>(left));
  });
  if (pixels < min_pixels) return;
  health.clipped_left = static_cast<double>(left_clipped) / static_cast<double>(pixels);
  health.clipped_right = static_cast<double>(right_clipped) / static_cast<double>(pixels);
  if (ratios.size() >= min_pixels) health.gain = static_cast<double>(upper_median(ratios));
}

/// Sum of the squared differences of the pixels of two rows, where both are road, and their number.
struct SquaredDifferences {
  static constexpr int max_run = 256;  ///< so many differences of at most grey_max, squared, fit into 32 bits
  std::uint64_t sum = 0, count = 0;

  /// `width`: at most max_run. The loop is vectorised.
  void add(const std::int16_t* image, const std::int16_t* other, const std::uint8_t* road,
           const std::uint8_t* other_road, int width) {
    std::uint32_t part = 0, pixels = 0;
    for (int u = 0; u < width; ++u) {
      const auto both = static_cast<std::int16_t>((road[u] & other_road[u]) != 0 ? 1 : 0);
      const auto difference = static_cast<std::int16_t>((other[u] - image[u]) * both);
      part += static_cast<std::uint32_t>(difference * difference);
      pixels += static_cast<std::uint32_t>(both);
    }
    sum += part;
    count += pixels;
  }
  double mean() const { return static_cast<double>(sum) / static_cast<double>(count); }
};

/// Two lags of a structure function, pixels.
struct Lags {
  int near, far;
};

/// Ratio of the structure function, the mean square of the differences of pixels `lag` apart, at two lags along rows or
/// columns, over the road: what a tenth of the tiles exceed, since the edges of shadows have the ratio of blur. Tiles
/// with less than half of the median contrast show noise, and do not count. Of large images it takes some 128 rows, an
/// odd number apart, so that they lie everywhere in the blocks of 8×8 pixels of JPEG.
double structure_ratio(Grey image, const DamageMap& damage, Lags lags, bool down) {
  constexpr int rows = 128, tiles_across = 20, min_tile = 32;
  constexpr std::uint64_t min_count = 100;
  constexpr double sharpest = 0.9, min_variance_share = 0.25;
  const int step = std::max(3, image.height() / rows | 1);
  const int side = std::max(image.width(), image.height());
  const int tile = std::clamp(side / tiles_across, min_tile, SquaredDifferences::max_run);
  const int right = image.width() - (down ? 0 : lags.far), bottom = image.height() - (down ? lags.far : 0);
  std::vector<double> ratios, variances;
  std::vector<SquaredDifferences> near, far;
  for (int v0 = 0; v0 < bottom; v0 += tile) {
    near.assign(static_cast<std::size_t>(std::max(0, right) / tile) + 1, {});
    far = near;
    const auto add = [&](int v, int u, int lag, SquaredDifferences& differences) {
      const int du = down ? 0 : lag, dv = down ? lag : 0;
      differences.add(image.row(v) + u, image.row(v + dv) + u + du, damage.road.row(v) + u,
                      damage.road.row(v + dv) + u + du, std::min(tile, right - u));
    };
    for (int v = v0; v < std::min(v0 + tile, bottom); v += step) {
      for (int u = 0; u < right; u += tile) {
        add(v, u, lags.near, near[static_cast<std::size_t>(u / tile)]);
        add(v, u, lags.far, far[static_cast<std::size_t>(u / tile)]);
      }
    }
    for (std::size_t k = 0; k < near.size(); ++k) {
      const bool is_known = std::min(near[k].count, far[k].count) >= min_count && far[k].sum > 0;
      if (!is_known) continue;
      ratios.push_back(near[k].mean() / far[k].mean());
      variances.push_back(far[k].mean());
    }
  }
  if (ratios.empty()) return PairHealth::unknown;
  const double min_variance = min_variance_share * upper_median(std::vector(variances));
  std::size_t with_contrast = 0;
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    if (variances[k] >= min_variance) ratios[with_contrast++] = ratios[k];
  }
  return nearest_quantile(std::span(ratios).first(with_contrast), sharpest);
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
  constexpr Lags lags{2, 12};
  double blur = 0;
  for (const bool down : {false, true}) {
    const double ratio = structure_ratio(image, damage, lags, down);
    if (std::isnan(ratio)) return PairHealth::unknown;
    blur = std::max(blur, blur_of_ratio(ratio, lags.near, lags.far));
  }
  return blur;
}

/// The blur of the image that was smoothed, before: that of the other one less the difference.
void undo_smoothing(double smoothed_px2, PairHealth& health) {
  if (smoothed_px2 == 0) return;
  const bool is_left = smoothed_px2 > 0;
  const double blur_px = is_left ? health.blur_right_px : health.blur_left_px;
  const double before_px2 = blur_px * blur_px - std::abs(smoothed_px2);
  (is_left ? health.blur_left_px : health.blur_right_px) = before_px2 < 0 ? 0 : std::sqrt(before_px2);
}

constexpr int noise_block_radius = 3;

/// Immerkær's mask, which takes away planes of grey levels; its coefficients squared sum to 36.
int noise_mask(Grey image, int u, int v) {
  const auto second_difference = [&](int row) { return image(u - 1, row) - 2 * image(u, row) + image(u + 1, row); };
  return second_difference(v - 1) - 2 * second_difference(v) + second_difference(v + 1);
}

/// In 1/16 grey level, squared.
double block_variance(Grey image, int at_u, int at_v) {
  constexpr int width = 2 * noise_block_radius + 1, pixels = width * width;
  int sum = 0, squares = 0;  // of 49 levels of at most grey_max
  for (int y = 0; y < width; ++y) {
    const std::int16_t* const row = image.row(at_v + y - noise_block_radius) + at_u - noise_block_radius;
    for (int x = 0; x < width; ++x) {
      sum += row[x];
      squares += row[x] * row[x];
    }
  }
  return (squares - static_cast<double>(sum) * sum / pixels) / (pixels - 1);
}

/// Variances of the white noise of a view and of that of its columns and rows, by the median variance of blocks of the
/// road. White noise is what the mask responds to differently in both views, where matches are nearly whole pixels:
/// fine texture is the same in both, but for the gain, by which the right levels are divided. To a column or a row the
/// mask does not respond.
void measure_noise(const FrameResult& frame, const DamageMap& damage, PairHealth& health) {
  constexpr double mask_norm = 6, max_fraction_px = 0.25;
  constexpr std::size_t min_blocks = 100;
  const double to_left = std::isnan(health.gain) ? 1 : 1 / health.gain;  // right levels times that are left ones
  std::vector<float> differences, variances;
  for_each_sample(frame.grey, noise_block_radius, [&](int u, int v) {
    const std::optional<Match> match = match_of(frame, damage, u, v, noise_block_radius);
    if (!match || match->off_px > max_fraction_px) return;
    differences.push_back(
        static_cast<float>(noise_mask(frame.grey, u, v) - to_left * noise_mask(frame.right, match->u, match->v)));
    const double right_variance = to_left * to_left * block_variance(frame.right, match->u, match->v);
    variances.push_back(static_cast<float>(0.5 * (block_variance(frame.grey, u, v) + right_variance)));
  });
  if (variances.size() < min_blocks) return;
  const double noise = gaussian_mad * upper_median_magnitude(differences) / mask_norm;
  const double variance = upper_median(variances);
  if (variance <= 0) return;
  health.noise_share = 0.5 * noise * noise / variance;
  constexpr double in_block = 0.875;  // 6/7 · 49/48: a block of 7×7 pixels has 7 stripes
  const double stripes =
      stripe_variance(frame.grey, damage.road) + to_left * to_left * stripe_variance(frame.right, damage.road);
  health.stripe_share = std::isnan(stripes) ? PairHealth::unknown : std::min(1.0, 0.5 * in_block * stripes / variance);
}

/// FrameResult::block_steps, or of the image as it is; of blocks that begin elsewhere where those show nothing.
double block_steps(double measured, Grey image) {
  constexpr double min_excess = 0.05;  // from there on the steps may be smoothed (`deblocking_strength`)
  const double excess = std::isnan(measured) ? measure_block_steps(image).excess() : measured;
  return excess < min_excess ? std::max(excess, block_grid_excess(image)) : excess;
}

}  // namespace

void measure_pictures(const FrameResult& frame, const DamageMap& damage, int threads, PairHealth& health) {
  constexpr int figures = 5;
  parallel_for(figures, threads, [&](int figure, int) {
    switch (figure) {
      case 0:
        measure_exposure(frame, damage, health);
        measure_noise(frame, damage, health);
        break;
      case 1:
        health.blur_left_px = blur_of(frame.grey, damage);
        break;
      case 2:
        health.blur_right_px = blur_of(frame.right, damage);
        break;
      case 3:
        health.blocks_left = block_steps(frame.block_steps[0], frame.grey);
        break;
      default:
        health.blocks_right = block_steps(frame.block_steps[1], frame.right);
    }
  });
  undo_smoothing(frame.smoothed_px2, health);
}

}  // namespace roadstereo

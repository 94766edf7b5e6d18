#include "damage/texture_share.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/order_statistics.hpp"
#include "damage/sampling_step.hpp"

namespace roadstereo {
namespace {

constexpr int block_px = 12;

/// Logarithm of the RMS of the gradient over the mean grey level of the block around (u, v); NaN at the border and of
/// a black block.
double contrast_of_block(ImageView<const std::int16_t> grey, int u, int v) {
  constexpr int half = block_px / 2, step = 2;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (u < half + 1 || v < half + 1 || u + half + 1 >= grey.width() || v + half + 1 >= grey.height()) return unknown;
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = v - half; y < v + half; y += step) {
    const std::int16_t *const row = grey.row(y), *const above = grey.row(y - 1), *const below = grey.row(y + 1);
    for (int x = u - half; x < u + half; x += step) {
      const double du = row[x + 1] - row[x - 1], dv = below[x] - above[x];
      squares += du * du + dv * dv;
      sum += row[x];
      ++count;
    }
  }
  if (sum <= 0 || squares <= 0) return unknown;
  return std::log(std::sqrt(squares / count) / (sum / count));
}

/// Contrasts of at most about `max_blocks` blocks on a regular grid of a box whose centres are `wanted`.
template <class Wanted>
std::vector<double> contrasts_of(ImageView<const std::int16_t> grey, const PixelBox& box, double max_blocks,
                                 const Wanted& wanted) {
  const int step = sampling_step(box, max_blocks, block_px / 2);
  std::vector<double> contrasts;
  for (int v = box.v0; v <= box.v1; v += step) {
    for (int u = box.u0; u <= box.u1; u += step) {
      if (!wanted(u, v)) continue;
      const double contrast = contrast_of_block(grey, u, v);
      if (!std::isnan(contrast)) contrasts.push_back(contrast);
    }
  }
  return contrasts;
}

}  // namespace

double texture_share(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box) {
  constexpr double max_inside = 128, max_around = 512, max_road = 512;
  constexpr std::size_t min_blocks = 8;
  constexpr int min_margin = 16;
  constexpr double max_sigmas = 2;  // of the inside, for the same texture
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (input.grey.empty()) return unknown;
  const int width = input.grey.width(), height = input.grey.height();
  const auto is_seen = [&](int u, int v) { return input.mask.empty() || input.mask(u, v) == 0; };
  std::vector<double> inside =
      contrasts_of(input.grey, box, max_inside, [&](int u, int v) { return maps.ids(u, v) == id; });
  const int margin = min_margin + std::min(box.width(), box.height()) / 2;
  const PixelBox around_box{std::max(0, box.u0 - margin), std::max(0, box.v0 - margin),
                            std::min(width - 1, box.u1 + margin), std::min(height - 1, box.v1 + margin)};
  const std::vector<double> around = contrasts_of(input.grey, around_box, max_around,
                                                  [&](int u, int v) { return maps.ids(u, v) != id && is_seen(u, v); });
  std::vector<double> road = contrasts_of(input.grey, {0, 0, width - 1, height - 1}, max_road, [&](int u, int v) {
    return maps.ids(u, v) == 0 && maps.road(u, v) != 0 && is_seen(u, v);
  });
  if (std::min({inside.size(), around.size(), road.size()}) < min_blocks) return unknown;
  const double of_inside = upper_median(inside), of_road = upper_median(road);
  for (double& contrast : inside) contrast -= of_inside;
  const double range = max_sigmas * gaussian_mad * upper_median_magnitude(inside);
  if (std::abs(of_inside - of_road) < range) return 0;  // of one texture, as far as can be told
  const auto share = [&](const std::vector<double>& contrasts) {
    const auto like_inside = std::count_if(contrasts.begin(), contrasts.end(), [&](double contrast) {
      return std::abs(contrast - of_inside) < std::min(range, std::abs(contrast - of_road));
    });
    return static_cast<double>(like_inside) / static_cast<double>(contrasts.size());
  };
  return share(around) - share(road);
}

}  // namespace roadstereo

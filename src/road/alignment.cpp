#include "roadstereo/alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "core/shrink.hpp"
#include "road/block_alignment.hpp"
#include "road/plane_fit.hpp"

namespace roadstereo {
namespace {

constexpr int coarse_width = 120;
constexpr int half_block = 4;
constexpr int block_pixels = (2 * half_block + 1) * (2 * half_block + 1);
constexpr int refined_radius = 8;
constexpr double least_correlation = 0.7;
constexpr double least_deviation = 2.0 * grey_scale;
constexpr int cells_across = 15;
constexpr int cells_down = 9;

/// A pair at its full size and small.
struct Pyramid {
  ImageView<const std::int16_t> left, right;
  int factor;
  GreyImage small_left, small_right;
  GreyImage smooth_left, smooth_right;  ///< for sampling between the pixels
};

/// The image under a 3×3 binomial filter: interpolating it does not smooth it much further, so that noise does not make
/// offsets of half a pixel look good.
GreyImage smoothed(ImageView<const std::int16_t> image, int threads) {
  GreyImage out(image.width(), image.height());
  parallel_rows(image.height(), 32, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      const std::int16_t* rows[3] = {image.row(std::max(0, v - 1)), image.row(v),
                                     image.row(std::min(image.height() - 1, v + 1))};
      const auto column = [&](int u) { return rows[0][u] + 2 * rows[1][u] + rows[2][u]; };
      std::int16_t* to = out.row(v);
      const int end = image.width() - 1;
      for (int u = 1; u < end; ++u) {
        to[u] = static_cast<std::int16_t>((column(u - 1) + 2 * column(u) + column(u + 1) + 8) / 16);
      }
      to[0] = to[1];
      to[end] = to[end - 1];
    }
  });
  return out;
}

struct Place {
  int u = 0;
  int v = 0;
};

/// Where a block sits in the right image, relative to its place in the left one.
struct Offset {
  int du = 0;
  int dv = 0;
  double correlation = -1;
};

bool inside(ImageView<const std::int16_t> image, int u, int v) {
  return u >= half_block && v >= half_block && u + half_block < image.width() && v + half_block < image.height();
}

double correlate(ImageView<const std::int16_t> left, const Place& a, ImageView<const std::int16_t> right,
                 const Place& b) {
  std::int32_t sl = 0, sr = 0, ll = 0, rr = 0, lr = 0;  // 81 products of at most 4080² fit
  for (int y = -half_block; y <= half_block; ++y) {
    const std::int16_t* l = left.row(a.v + y) + a.u;
    const std::int16_t* r = right.row(b.v + y) + b.u;
    for (int x = -half_block; x <= half_block; ++x) {
      sl += l[x];
      sr += r[x];
      ll += l[x] * l[x];
      rr += r[x] * r[x];
      lr += l[x] * r[x];
    }
  }
  const double mean_l = static_cast<double>(sl) / block_pixels;
  const double mean_r = static_cast<double>(sr) / block_pixels;
  const double variance_l = static_cast<double>(ll) / block_pixels - mean_l * mean_l;
  const double variance_r = static_cast<double>(rr) / block_pixels - mean_r * mean_r;
  if (std::min(variance_l, variance_r) < least_deviation * least_deviation) return -1;
  return (static_cast<double>(lr) / block_pixels - mean_l * mean_r) / std::sqrt(variance_l * variance_r);
}

/// The place of a cell whose rows differ most: only there a vertical offset can be seen.
std::optional<Place> best_place(ImageView<const std::int16_t> image, int u0, int v0, int u1, int v1) {
  Place best;
  int strongest = 0;
  for (int v = std::max(v0, half_block + 1); v < std::min(v1, image.height() - half_block - 1); v += 2) {
    for (int u = std::max(u0, half_block + 1); u < std::min(u1, image.width() - half_block - 1); u += 2) {
      const int down = std::abs(image(u, v + 1) - image(u, v - 1));
      const int across = std::abs(image(u + 1, v) - image(u - 1, v));
      if (std::min(down, across) > strongest) {
        strongest = std::min(down, across);
        best = {u, v};
      }
    }
  }
  if (strongest == 0) return std::nullopt;
  return best;
}

Offset search(ImageView<const std::int16_t> left, const Place& place, ImageView<const std::int16_t> right,
              const Offset& lowest, const Offset& highest) {
  Offset best;
  for (int dv = lowest.dv; dv <= highest.dv; ++dv) {
    for (int du = lowest.du; du <= highest.du; ++du) {
      if (!inside(right, place.u + du, place.v + dv)) continue;
      const double correlation = correlate(left, place, right, {place.u + du, place.v + dv});
      if (correlation > best.correlation) best = {du, dv, correlation};
    }
  }
  return best;
}

/// The vertical offsets that one row of cells shows.
std::vector<double> measure_cells(const Pyramid& pair, int cell_v) {
  const int rows = 1 + pair.small_left.height() / 40;
  const int columns = 2 * pair.small_left.width() / 5;
  const int reach = pair.factor / 2 + 1;
  std::vector<double> offsets;
  for (int cell_u = 0; cell_u < cells_across; ++cell_u) {
    const auto place = best_place(pair.small_left, cell_u * pair.small_left.width() / cells_across,
                                  cell_v * pair.small_left.height() / cells_down,
                                  (cell_u + 1) * pair.small_left.width() / cells_across,
                                  (cell_v + 1) * pair.small_left.height() / cells_down);
    if (!place) continue;
    const Offset coarse = search(pair.small_left, *place, pair.small_right, {-columns, -rows}, {0, rows});
    if (coarse.correlation < least_correlation) continue;
    const Place full{static_cast<int>(std::lround(unshrink(place->u, pair.factor))),
                     static_cast<int>(std::lround(unshrink(place->v, pair.factor)))};
    if (!inside(pair.left, full.u, full.v)) continue;
    const Offset fine =
        search(pair.left, full, pair.right, {coarse.du * pair.factor - reach, coarse.dv * pair.factor - reach},
               {coarse.du * pair.factor + reach, coarse.dv * pair.factor + reach});
    if (fine.correlation < least_correlation) continue;
    const BlockAlignment start{.du = static_cast<double>(fine.du), .dv = static_cast<double>(fine.dv)};
    const auto aligned = align_block(pair.smooth_left, full.u, full.v, pair.smooth_right, start, refined_radius);
    if (aligned) offsets.push_back(aligned->dv);
  }
  return offsets;
}

}  // namespace

RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads) {
  int factor = 1;
  while (left.width() / (2 * factor) >= coarse_width) factor *= 2;
  const Pyramid pair{left,
                     right,
                     factor,
                     shrink(left, factor),
                     shrink(right, factor),
                     smoothed(left, threads),
                     smoothed(right, threads)};
  std::vector<std::vector<double>> by_row(cells_down);
  parallel_for(cells_down, threads,
               [&](int cell_v, int) { by_row[static_cast<std::size_t>(cell_v)] = measure_cells(pair, cell_v); });
  std::vector<double> offsets;
  for (const auto& row : by_row) offsets.insert(offsets.end(), row.begin(), row.end());
  RowAlignment alignment;
  alignment.points = static_cast<int>(offsets.size());
  if (offsets.empty()) return alignment;
  std::sort(offsets.begin(), offsets.end());
  alignment.median_px = offsets[offsets.size() / 2];
  for (double& offset : offsets) offset -= alignment.median_px;
  alignment.spread_px = normal_from_median * median_magnitude(offsets);
  return alignment;
}

}  // namespace roadstereo

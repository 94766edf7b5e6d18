#include "roadstereo/alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/downsample.hpp"
#include "core/mid_grey.hpp"
#include "core/order_statistics.hpp"
#include "core/parallel.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/black_border.hpp"
#include "road/block_alignment.hpp"
#include "road/masked_blocks.hpp"
#include "road/plane_fit.hpp"
#include "road/road_search.hpp"
#include "road/row_offset_fit.hpp"
#include "road/strip_correlation.hpp"

namespace roadstereo {
namespace {

constexpr int half_block = 4;
constexpr int refined_radius = 8;
constexpr float min_correlation = 0.7f;
constexpr float min_deviation = 2.0f * grey_scale;
constexpr int cells_across = 15;
constexpr int cells_down = 9;

/// A pair, downsampled if it is large: beyond that size blocks of a few pixels show nothing but blur; and small.
struct Pyramid {
  ImageView<const std::int16_t> left, right;
  int factor;
  ImageView<const std::int16_t> small_left, small_right;
  MaskedBlocks masked;  ///< of the small left image
};

/// The matched points of one row of cells.
struct CellRow {
  std::array<RowSample, cells_across> samples;
  std::size_t count = 0;
};

/// The surroundings of a pixel under a 3×3 binomial filter: interpolating them does not smooth them much further, so
/// that noise does not make offsets of half a pixel look good.
class SmoothPatch {
 public:
  static constexpr int max_radius = 16;

  /// As far as the image goes, but for its outermost pixels.
  SmoothPatch(ImageView<const std::int16_t> image, int u, int v, int radius)
      : first_u_(std::max(1, u - radius)), first_v_(std::max(1, v - radius)) {
    width_ = std::max(0, std::min(image.width() - 2, u + radius) - first_u_ + 1);
    height_ = std::max(0, std::min(image.height() - 2, v + radius) - first_v_ + 1);
    for (int y = 0; y < height_; ++y) smooth_row(image, y);
  }

  int first_u() const { return first_u_; }
  int first_v() const { return first_v_; }
  ImageView<const std::int16_t> view() const { return {pixels_.data(), width_, height_, pitch}; }

 private:
  static constexpr int pitch = 2 * max_radius + 1;

  void smooth_row(ImageView<const std::int16_t> image, int y) {
    const std::int16_t* above = image.row(first_v_ + y - 1) + first_u_ - 1;
    const std::int16_t* here = image.row(first_v_ + y) + first_u_ - 1;
    const std::int16_t* below = image.row(first_v_ + y + 1) + first_u_ - 1;
    std::array<std::uint16_t, pitch + 2> columns{};  // 16 · 4080 + 8 fits
    for (int x = 0; x < width_ + 2; ++x) {
      columns[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
    }
    std::int16_t* to = pixels_.data() + static_cast<std::ptrdiff_t>(y) * pitch;
    const std::uint16_t* column = columns.data();
    for (int x = 0; x < width_; ++x) {
      const auto sum = static_cast<std::uint16_t>(column[x] + 2 * column[x + 1] + column[x + 2] + 8);
      to[x] = static_cast<std::int16_t>(sum >> 4);
    }
  }

  int first_u_, first_v_, width_ = 0, height_ = 0;
  std::array<std::int16_t, static_cast<std::size_t>(pitch* pitch)> pixels_{};
};

struct Place {
  int u = 0;
  int v = 0;
};

/// Where a block sits in the right image, relative to its place in the left one.
struct Offset {
  int du = 0;
  int dv = 0;
  float correlation = -1;
};

bool inside(ImageView<const std::int16_t> image, int u, int v) {
  return u >= half_block && v >= half_block && u + half_block < image.width() && v + half_block < image.height();
}

/// The place of a cell whose rows differ most, with no masked pixel around it: only there a vertical offset can be
/// seen.
std::optional<Place> best_place(ImageView<const std::int16_t> image, const MaskedBlocks& masked, int u0, int v0, int u1,
                                int v1) {
  Place best;
  int strongest = 0;
  for (int v = std::max(v0, half_block + 1); v < std::min(v1, image.height() - half_block - 1); v += 2) {
    for (int u = std::max(u0, half_block + 1); u < std::min(u1, image.width() - half_block - 1); u += 2) {
      const int down = std::abs(image(u, v + 1) - image(u, v - 1));
      const int across = std::abs(image(u + 1, v) - image(u - 1, v));
      if (std::min(down, across) > strongest && !masked.contains(u, v, half_block, half_block)) {
        strongest = std::min(down, across);
        best = {u, v};
      }
    }
  }
  if (strongest == 0) return std::nullopt;
  return best;
}

/// Cuts a row of a strip out of an image.
void copy_strip(const std::int16_t* from, int columns, float* strip_row) {
  for (int x = 0; x < columns; ++x) strip_row[x] = static_cast<float>(from[x]) - static_cast<float>(mid_grey);
}

/// The best of all whole offsets between two; the block around `place` must lie inside the left image.
Offset search(ImageView<const std::int16_t> left, const Place& place, ImageView<const std::int16_t> right,
              const Offset& lowest, const Offset& highest, Strip& strip) {
  Offset best;
  const CorrelationBlock block(left, place.u, place.v, half_block, half_block);
  const int first = std::max(lowest.du, half_block - place.u);
  const int count = std::min(highest.du, right.width() - half_block - 1 - place.u) - first + 1;
  if (block.deviation < min_deviation || count < 1) return best;
  StripValues inverse_deviations, correlations;
  for (int dv = lowest.dv; dv <= highest.dv; ++dv) {
    const int top = place.v + dv - half_block;
    if (top < 0 || top + block.height > right.height()) continue;
    for (int y = 0; y < block.height; ++y) {
      copy_strip(right.row(top + y) + place.u + first - half_block, count + block.width - 1, strip.row(y));
    }
    find_inverse_deviations(strip.view(), block.width, block.height, count, min_deviation, inverse_deviations.data());
    correlate_strip(block, strip.view(), inverse_deviations.data(), count, correlations);
    const int i = index_of_highest(correlations, count);
    const float correlation = correlations[static_cast<std::size_t>(i)];
    if (correlation > best.correlation) best = {first + i, dv, correlation};
  }
  return best;
}

/// The vertical offset of a block to a fraction of a pixel.
std::optional<double> refined_offset(const Pyramid& pair, const Place& place, const Offset& offset) {
  constexpr int room = SmoothPatch::max_radius - refined_radius;  // for the slant of the road
  const SmoothPatch left(pair.left, place.u, place.v, refined_radius);
  const SmoothPatch right(pair.right, place.u + offset.du, place.v + offset.dv, refined_radius + room);
  // From the one patch's coordinates to the other's.
  const int shift_u = left.first_u() - right.first_u(), shift_v = left.first_v() - right.first_v();
  const BlockAlignment start{.du = static_cast<double>(offset.du + shift_u),
                             .dv = static_cast<double>(offset.dv + shift_v)};
  const auto aligned = affine_lucas_kanade(left.view(), place.u - left.first_u(), place.v - left.first_v(),
                                           right.view(), start, refined_radius);
  if (!aligned) return std::nullopt;
  return aligned->dv - shift_v;
}

CellRow measure_cells(const Pyramid& pair, int cell_v) {
  const int rows = 1 + pair.small_left.height() / 40;
  const int columns = 2 * pair.small_left.width() / 5;
  const int reach = pair.factor / 2 + 1;
  CellRow row;
  Strip strip{};
  for (int cell_u = 0; cell_u < cells_across; ++cell_u) {
    const auto place = best_place(pair.small_left, pair.masked, cell_u * pair.small_left.width() / cells_across,
                                  cell_v * pair.small_left.height() / cells_down,
                                  (cell_u + 1) * pair.small_left.width() / cells_across,
                                  (cell_v + 1) * pair.small_left.height() / cells_down);
    if (!place) continue;
    const Offset coarse = search(pair.small_left, *place, pair.small_right, {-columns, -rows}, {0, rows}, strip);
    if (coarse.correlation < min_correlation) continue;
    const Place full{static_cast<int>(std::lround(to_full_resolution(place->u, pair.factor))),
                     static_cast<int>(std::lround(to_full_resolution(place->v, pair.factor)))};
    if (!inside(pair.left, full.u, full.v)) continue;
    const Offset fine =
        search(pair.left, full, pair.right, {coarse.du * pair.factor - reach, coarse.dv * pair.factor - reach},
               {coarse.du * pair.factor + reach, coarse.dv * pair.factor + reach}, strip);
    if (fine.correlation < min_correlation) continue;
    if (const auto dv = refined_offset(pair, full, fine)) {
      row.samples[row.count++] = {1.0 * full.u, 1.0 * full.v, 1.0 * fine.du, *dv};
    }
  }
  return row;
}

/// Power of two that leaves between 120 and 240 columns: the search over all disparities fits into a strip.
int alignment_factor(int width) {
  constexpr int min_width = 120;
  int factor = 1;
  while (width / (2 * factor) >= min_width) factor *= 2;
  return factor;
}

/// The image downsampled, in `pixels`.
ImageView<const std::int16_t> downsampled(ImageView<const std::int16_t> image, int factor,
                                          ScratchVector<std::int16_t>& pixels) {
  if (factor == 1) return image;
  const int width = image.width() / factor, height = image.height() / factor;
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const ImageView<std::int16_t> small(pixels.data(), width, height, width);
  downsample(image, factor, small);
  return small;
}

ScratchVector<RowSample> match_cells(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                     int threads, ImageView<const std::uint8_t> mask) {
  require_one_size({left.width(), left.height()}, {right.width(), right.height()});
  require_mask_size({mask.width(), mask.height()}, {left.width(), left.height()});
  const PictureMask picture(left, mask);
  const int fine = fine_factor(left.width()), factor = alignment_factor(left.width() / fine);
  auto fine_left = scratch_vector<std::int16_t>(), fine_right = scratch_vector<std::int16_t>();
  auto left_pixels = scratch_vector<std::int16_t>(), right_pixels = scratch_vector<std::int16_t>();
  const Pyramid pair{downsampled(left, fine, fine_left),
                     downsampled(right, fine, fine_right),
                     factor,
                     downsampled(left, fine * factor, left_pixels),
                     downsampled(right, fine * factor, right_pixels),
                     {picture.view(), fine * factor}};
  std::array<CellRow, cells_down> rows;
  parallel_for(cells_down, threads,
               [&](int cell_v, int) { rows[static_cast<std::size_t>(cell_v)] = measure_cells(pair, cell_v); });
  auto samples = scratch_vector<RowSample>();
  samples.reserve(std::size_t{cells_across} * cells_down);
  for (const CellRow& row : rows) {
    samples.insert(samples.end(), row.samples.begin(), row.samples.begin() + static_cast<std::ptrdiff_t>(row.count));
  }
  for (RowSample& sample : samples) {
    sample = {to_full_resolution(sample.u, fine), to_full_resolution(sample.v, fine), sample.du * fine,
              sample.dv * fine};
  }
  return samples;
}

}  // namespace

std::vector<RowSample> sample_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                            int threads, ImageView<const std::uint8_t> mask) {
  const ScratchVector<RowSample> samples = match_cells(left, right, threads, mask);
  return {samples.begin(), samples.end()};
}

RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int threads,
                                   ImageView<const std::uint8_t> mask) {
  const ScratchVector<RowSample> samples = match_cells(left, right, threads, mask);
  auto offsets = scratch_vector<double>();
  offsets.reserve(samples.size());
  for (const RowSample& sample : samples) offsets.push_back(sample.dv);
  RowAlignment alignment;
  alignment.points = static_cast<int>(offsets.size());
  if (offsets.empty()) return alignment;
  alignment.median_px = upper_median(offsets);
  for (double& offset : offsets) offset -= alignment.median_px;
  alignment.sigma_px = gaussian_mad * upper_median_magnitude(offsets);
  if (!alignment.known()) return alignment;
  alignment.fit = fit_row_offset(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    offsets[k] = samples[k].dv - alignment.fit.at(samples[k].u + samples[k].du, samples[k].v);
  }
  alignment.fit_sigma_px = gaussian_mad * upper_median_magnitude(offsets);
  return alignment;
}

}  // namespace roadstereo

#include "road/coarse_match.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/downsample.hpp"
#include "core/parabola.hpp"
#include "core/parallel.hpp"
#include "road/masked_blocks.hpp"
#include "road/row_correlation.hpp"

namespace roadstereo {
namespace {

constexpr int half_width = row_block_half_width;
constexpr int half_height = row_block_half_height;
/// Noise of a pixel. That of the shrunk images, whose pixels are means, is added to the variance of a block: what has
/// less texture correlates with nothing.
constexpr float noise_deviation = 1.0f * grey_scale;
constexpr float min_correlation = 0.7f;
constexpr float min_margin = 0.03f;  ///< by which the best must beat every other but its neighbours
constexpr int band_rows = 12;

std::ptrdiff_t padded(int size) {
  return (size + row_guard - 1) / row_guard * row_guard + row_guard;
}

/// How the rows of all buffers are laid out: `front` elements without effect, then the columns, then a guard.
struct Layout {
  int width;
  int disparities;
  std::ptrdiff_t front = padded(disparities);
  std::ptrdiff_t pitch = padded(width);

  std::size_t row_size() const { return static_cast<std::size_t>(front + pitch); }
  std::size_t volume_size() const {
    return static_cast<std::size_t>(2 * row_guard + static_cast<std::ptrdiff_t>(disparities) * pitch);
  }
};

/// A shrunk image with zeros around its rows.
class PaddedImage {
 public:
  PaddedImage(ImageView<const std::int16_t> image, int factor, const Layout& layout)
      : pixels_(scratch_vector<std::int16_t>(layout.row_size() * static_cast<std::size_t>(image.height() / factor))),
        view_(pixels_.data() + layout.front, layout.width, image.height() / factor,
              static_cast<std::ptrdiff_t>(layout.row_size())) {
    downsample(image, factor, view_);
  }

  int height() const { return view_.height(); }
  const std::int16_t* row(int v) const { return view_.row(v); }

 private:
  ScratchVector<std::int16_t> pixels_;
  ImageView<std::int16_t> view_;
};

/// What a band of rows needs beside the images.
class BandMemory {
 public:
  explicit BandMemory(const Layout& layout)
      : front_(layout.front),
        row_size_(layout.row_size()),
        sums_(scratch_vector<std::int32_t>(layout.volume_size())),
        values_(scratch_vector<float>(layout.volume_size())),
        posterior_(scratch_vector<float>(static_cast<std::size_t>(layout.disparities * row_guard))),
        rows_(scratch_vector<float>(row_count * row_size_)),
        whole_rows_(scratch_vector<std::int32_t>(whole_row_count * row_size_)),
        columns_(scratch_vector<std::int32_t>(2 * row_size_)) {}

  void clear_sums() { std::fill(sums_.begin(), sums_.end(), 0); }
  std::int32_t* sums() { return sums_.data() + row_guard; }
  float* values() { return values_.data(); }
  std::int32_t* column_sums() { return columns_.data(); }
  std::int32_t* column_squares() { return columns_.data() + row_size_; }

  BlockRow left() { return {whole_row(0), whole_row(1), row(0), row(1)}; }
  BlockRow right() { return {whole_row(2), whole_row(3), row(2), row(3)}; }
  BestOfRow best_of_left() { return {row(4), row(5)}; }
  BestOfRow best_of_right() { return {row(6), row(7)}; }
  float* rivals() { return row(8); }
  float* posterior() { return posterior_.data(); }

  /// No disparity is the best yet.
  void clear_best() { std::fill_n(row(4) - front_, 4 * row_size_, -1.0f); }

 private:
  static constexpr std::size_t row_count = 9, whole_row_count = 4;
  float* row(std::size_t i) { return rows_.data() + i * row_size_ + front_; }
  std::int32_t* whole_row(std::size_t i) { return whole_rows_.data() + i * row_size_ + front_; }

  std::ptrdiff_t front_;
  std::size_t row_size_;
  ScratchVector<std::int32_t> sums_;
  ScratchVector<float> values_, posterior_, rows_;
  ScratchVector<std::int32_t> whole_rows_, columns_;
};

/// Sum of a block's columns.
std::int32_t block_sum(const std::int32_t* centre) {
  std::int32_t sum = 0;
  for (int x = -half_width; x <= half_width; ++x) sum += centre[x];
  return sum;
}

void describe_blocks(const PaddedImage& image, int v, int width, float noise, const MaskedBlocks& masked,
                     BandMemory& memory, const BlockRow& blocks) {
  std::int32_t* sums = memory.column_sums();
  std::int32_t* squares = memory.column_squares();
  std::fill_n(sums, width, 0);
  std::fill_n(squares, width, 0);
  for (int y = v - half_height; y <= v + half_height; ++y) {
    const std::int16_t* row = image.row(y);
    for (int u = 0; u < width; ++u) {
      sums[u] += row[u];
      squares[u] += row[u] * row[u];
    }
  }
  for (int u = half_width; u + half_width < width; ++u) {
    const std::int32_t sum = block_sum(sums + u), mean = (sum + row_block_pixels / 2) / row_block_pixels;
    const std::int32_t rest = sum - row_block_pixels * mean;
    const float residue = static_cast<float>(rest) / row_block_pixels;
    // n·σ² = Σ i² − mean·(sum + rest) − rest² / n, whole numbers up to the last term.
    const float deviations = static_cast<float>(block_sum(squares + u) - mean * (sum + rest));
    const float variance = deviations / row_block_pixels - residue * residue;
    blocks.sum[u] = sum;
    blocks.mean[u] = mean;
    blocks.residue[u] = residue;
    blocks.inverse_deviation[u] =
        masked.contains(u, v, half_width, half_height) ? 0.0f : 1 / std::sqrt(std::max(variance, 0.0f) + noise * noise);
  }
}

/// Position of the maximum, by a parabola through the best and its neighbours.
double refine(const RowCorrelations& row, int u, int d) {
  if (d == 0 || d + 1 >= row.disparities) return d;
  const float* at = row.values + d * row.pitch + u;
  const float before = at[-row.pitch], after = at[row.pitch];
  if (before <= -1 || after <= -1) return d;
  return second_difference(before, *at, after) < 0 ? d + static_cast<double>(parabola_vertex(before, *at, after)) : d;
}

/// The reliable matches of one row of the shrunk pair: distinct, and found from both sides. Returns how many.
std::size_t collect(const RowCorrelations& row, BandMemory& memory, int v, int factor, DisparityPoint* matches) {
  const BestOfRow left = memory.best_of_left(), right = memory.best_of_right();
  find_rivals(row, left.disparity, memory.rivals());
  std::size_t found = 0;
  for (int u = 0; u < row.width; ++u) {
    if (left.correlation[u] < min_correlation) continue;
    const int d = static_cast<int>(left.disparity[u]);
    if (std::abs(right.disparity[u - d] - left.disparity[u]) > 1) continue;
    if (memory.rivals()[u] > left.correlation[u] - min_margin) continue;
    matches[found++] = {to_full_resolution(u, factor), to_full_resolution(v, factor), refine(row, u, d) * factor};
  }
  return found;
}

/// A shrunk pair.
struct SmallPair {
  PaddedImage left, right;
  MaskedBlocks masked;  ///< of the left image
  Layout layout;
  int factor;
};

/// The matches of the rows whose blocks begin at the rows first … last − 1. Sums of products slide from row to row;
/// they are whole numbers, so that it does not matter where a band begins.
std::size_t match_band(const SmallPair& pair, int first, int last, BandMemory& memory, DisparityPoint* matches,
                       DisparityEvidence& evidence) {
  const int width = pair.layout.width;
  const float noise = noise_deviation / static_cast<float>(pair.factor);
  const RowCorrelations row{memory.values(), pair.layout.pitch, width, pair.layout.disparities};
  const auto add = [&](int v, int sign) {
    add_products(pair.left.row(v), pair.right.row(v), row, sign, memory.sums());
  };
  memory.clear_sums();
  for (int v = first; v < first + 2 * half_height; ++v) add(v, 1);
  std::size_t found = 0;
  for (int top = first; top < last; ++top) {
    const int v = top + half_height;
    add(v + half_height, 1);
    describe_blocks(pair.left, v, width, noise, pair.masked, memory, memory.left());
    describe_blocks(pair.right, v, width, noise, {}, memory, memory.right());
    memory.clear_best();
    correlate_row(memory.sums(), memory.left(), memory.right(), row, memory.best_of_left(), memory.best_of_right());
    found += collect(row, memory, v, pair.factor, matches + found);
    for (int column = 0; column < evidence.columns(); ++column) {
      add_evidence(row, column * evidence_columns, memory.posterior(), evidence.cell(top / evidence_rows, column));
    }
    add(top, -1);
  }
  return found;
}

}  // namespace

CoarseMatches match_coarsely(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int factor,
                             double max_disparity_px, int threads, ImageView<const std::uint8_t> mask) {
  static_assert(band_rows % evidence_rows == 0);
  CoarseMatches matches;
  const int width = left.width() / factor;
  const int rows = left.height() / factor - 2 * half_height;
  const int disparities = std::min(static_cast<int>(max_disparity_px / factor) + 1, width - 2 * half_width);
  matches.factor = factor;
  matches.first_row = half_height;
  matches.width = width;
  matches.height = left.height() / factor;
  if (rows < 1 || disparities < 1) return matches;
  const Layout layout{width, disparities};
  const SmallPair pair{PaddedImage(left, factor, layout), PaddedImage(right, factor, layout),
                       MaskedBlocks(mask, factor), layout, factor};
  const int bands = (rows + band_rows - 1) / band_rows;
  const int workers = resolve_threads(threads);
  std::pmr::vector<BandMemory> memory(ScratchScope::memory());
  memory.reserve(static_cast<std::size_t>(workers));
  for (int worker = 0; worker < workers; ++worker) memory.emplace_back(layout);
  const std::size_t band_size = static_cast<std::size_t>(band_rows) * static_cast<std::size_t>(width);
  auto by_band = scratch_vector<DisparityPoint>(static_cast<std::size_t>(bands) * band_size);
  auto found = scratch_vector<std::size_t>(static_cast<std::size_t>(bands));
  matches.evidence = DisparityEvidence((rows + evidence_rows - 1) / evidence_rows,
                                       (width + evidence_columns - 1) / evidence_columns, disparities);
  parallel_rows(rows, band_rows, threads, [&](int first, int last, int worker) {
    const auto band = static_cast<std::size_t>(first / band_rows);
    found[band] = match_band(pair, first, last, memory[static_cast<std::size_t>(worker)],
                             by_band.data() + band * band_size, matches.evidence);
  });
  for (std::size_t band = 0; band < found.size(); ++band) {
    const DisparityPoint* of_band = by_band.data() + band * band_size;
    matches.points.insert(matches.points.end(), of_band, of_band + found[band]);
  }
  return matches;
}

}  // namespace roadstereo

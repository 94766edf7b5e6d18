#include "stereo/coarse/tile_ranges.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "stereo/coarse/tile_range.hpp"

namespace roadstereo {
namespace {

/// Counts in the histograms of a row of tiles. Neighbouring pixels mostly agree: a run of them is added at once.
class RunCounter {
 public:
  RunCounter(std::uint32_t* histograms, std::size_t bins) : histograms_(histograms), bins_(bins) {}

  void add(const TileSpan& tiles, int bin) {
    if (bin != bin_ || tiles.first != tiles_.first || tiles.last != tiles_.last) {
      finish();
      tiles_ = tiles;
      bin_ = bin;
    }
    ++count_;
  }
  /// Adds the last run.
  void finish() {
    for (int tile = tiles_.first; tile <= tiles_.last; ++tile) {
      histograms_[static_cast<std::size_t>(tile) * bins_ + static_cast<std::size_t>(bin_)] += count_;
    }
    count_ = 0;
  }

 private:
  std::uint32_t* histograms_;
  std::size_t bins_;
  TileSpan tiles_{0, -1};
  int bin_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace

void TileRanges::count(const Image<float>& coarse, int factor, int threads) {
  const int across = ranges_.reference.width(), down = ranges_.reference.height();
  const std::size_t tiles = ranges_.reference.pixels();
  in_reference_.assign(tiles * bins_, 0);
  in_target_.assign(tiles * bins_, 0);
  const int tile_columns = SearchRanges::tile_columns / factor, tile_rows = SearchRanges::tile_rows / factor;
  columns_.resize(static_cast<std::size_t>(coarse.width()));
  for (int u = 0; u < coarse.width(); ++u) columns_[static_cast<std::size_t>(u)] = tiles_of(u, tile_columns, across);
  parallel_rows(down, 1, threads, [&](int first, int last, int) {
    for (int row = first; row < last; ++row) {
      const int begin = row == 0 ? 0 : std::max(0, row * tile_rows - tile_overlap);
      const int end =
          row + 1 == down ? coarse.height() : std::min(coarse.height(), (row + 1) * tile_rows + tile_overlap);
      const std::size_t counts = static_cast<std::size_t>(row) * static_cast<std::size_t>(across) * bins_;
      for (int v = begin; v < end; ++v) count_row(coarse.row(v), coarse.width(), factor, counts);
    }
  });
}

/// Counts a row of the coarse map in a row of tiles, whose histograms begin at `counts`.
void TileRanges::count_row(const float* row, int width, int factor, std::size_t counts) {
  const float inverse_factor = 1.0f / static_cast<float>(factor);
  const auto bins = static_cast<int>(bins_);
  RunCounter reference(in_reference_.data() + counts, bins_), target(in_target_.data() + counts, bins_);
  for (int u = 0; u < width; ++u) {
    if (std::isnan(row[u])) continue;
    const int bin = disparity_bin(row[u], bins);
    const int column = std::min(width - 1, tile_target_column(u, row[u], inverse_factor));
    reference.add(columns_[static_cast<std::size_t>(u)], bin);
    target.add(columns_[static_cast<std::size_t>(std::max(0, column))], bin);
  }
  reference.finish();
  target.finish();
}

/// From the first to the last disparity that enough pixels of the tile agree on; all where too few pixels matched.
void TileRanges::choose(const std::vector<std::uint32_t>& counts, Image<SearchRange>& ranges, int factor,
                        int disparities) const {
  const int tile_pixels = (SearchRanges::tile_columns / factor) * (SearchRanges::tile_rows / factor);
  const auto last = static_cast<int>(bins_) - 1;
  for (int tile = 0; tile < static_cast<int>(ranges.pixels()); ++tile) {
    const std::uint32_t* of_tile = counts.data() + static_cast<std::size_t>(tile) * bins_;
    std::uint32_t seen = 0;
    for (std::size_t d = 0; d < bins_; ++d) seen += of_tile[d];
    SearchRange& range = ranges(tile % ranges.width(), tile / ranges.width());
    if (seen < min_tile_pixels(tile_pixels)) continue;
    const std::uint32_t needed = needed_support(seen);
    const auto supported = [&](int d) { return is_supported(of_tile, last + 1, d, factor, needed); };
    int lowest = 0, highest = last;
    while (lowest < last && !supported(lowest)) ++lowest;
    while (highest > lowest && !supported(std::max(0, highest - factor + 1))) --highest;
    while (lowest < highest && of_tile[lowest] == 0) ++lowest;
    while (highest > lowest && of_tile[highest] == 0) --highest;
    range = range_around(lowest, highest, disparities);
  }
}

void TileRanges::find(const Image<float>& coarse, int factor, int width, int height, int disparities, int threads) {
  ranges_.assign(width, height, disparities);
  const int bins = disparities + factor;
  bins_ = static_cast<std::size_t>(bins);
  count(coarse, factor, threads);
  choose(in_reference_, ranges_.reference, factor, disparities);
  choose(in_target_, ranges_.target, factor, disparities);
}

}  // namespace roadstereo

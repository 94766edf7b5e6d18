#include "stereo/coarse/tile_ranges.hpp"

#include <algorithm>
#include <cmath>

#include "stereo/coarse/tile_range.hpp"

namespace roadstereo {

void TileRanges::count(const Image<float>& coarse, int factor) {
  const int across = ranges_.reference.width(), down = ranges_.reference.height();
  const std::size_t tiles = ranges_.reference.pixels();
  in_reference_.assign(tiles * bins_, 0);
  in_target_.assign(tiles * bins_, 0);
  const int tile_columns = SearchRanges::tile_columns / factor, tile_rows = SearchRanges::tile_rows / factor;
  const float inverse_factor = 1.0f / static_cast<float>(factor);
  for (int v = 0; v < coarse.height(); ++v) {
    const float* row = coarse.row(v);
    const TileSpan rows = tiles_of(v, tile_rows, down);
    for (int u = 0; u < coarse.width(); ++u) {
      if (std::isnan(row[u])) continue;
      const auto bin = static_cast<std::size_t>(disparity_bin(row[u], static_cast<int>(bins_)));
      const auto add = [&](std::vector<std::uint32_t>& counts, int column) {
        const TileSpan columns = tiles_of(column, tile_columns, across);
        for (int r = rows.first; r <= rows.last; ++r) {
          for (int c = columns.first; c <= columns.last; ++c) {
            const int tile = r * across + c;
            ++counts[static_cast<std::size_t>(tile) * bins_ + bin];
          }
        }
      };
      add(in_reference_, u);
      add(in_target_, tile_target_column(u, row[u], inverse_factor));
    }
  }
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

void TileRanges::find(const Image<float>& coarse, int factor, int width, int height, int disparities) {
  ranges_.assign(width, height, disparities);
  const int bins = disparities + factor;
  bins_ = static_cast<std::size_t>(bins);
  count(coarse, factor);
  choose(in_reference_, ranges_.reference, factor, disparities);
  choose(in_target_, ranges_.target, factor, disparities);
}

}  // namespace roadstereo

#include "stereo/coarse/tile_ranges.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

constexpr int margin = 3;      // disparities beyond those seen
constexpr int overlap = 2;     // coarse pixels of the neighbouring tiles that count too
constexpr int range_grid = 8;  // ranges grow to multiples of this: vectors hold so many anyway

/// First and last tile that a coarse column or row belongs to.
struct Tiles {
  int first, last;
  Tiles(int at, int size, int count)
      : first(std::clamp((at - overlap) / size, 0, count - 1)), last(std::clamp((at + overlap) / size, 0, count - 1)) {}
};

}  // namespace

void TileRanges::count(const Image<float>& coarse, int factor) {
  const int across = ranges_.reference.width(), down = ranges_.reference.height();
  const std::size_t tiles = ranges_.reference.pixels();
  in_reference_.assign(tiles * bins_, 0);
  in_target_.assign(tiles * bins_, 0);
  const int tile_columns = SearchRanges::tile_columns / factor, tile_rows = SearchRanges::tile_rows / factor;
  const float inverse_factor = 1.0f / static_cast<float>(factor);
  for (int v = 0; v < coarse.height(); ++v) {
    const float* row = coarse.row(v);
    const Tiles rows(v, tile_rows, down);
    for (int u = 0; u < coarse.width(); ++u) {
      if (std::isnan(row[u])) continue;
      const auto bin = std::min(bins_ - 1, static_cast<std::size_t>(std::max(0.0f, row[u] + 0.5f)));
      const auto add = [&](std::vector<std::uint32_t>& counts, int column) {
        const Tiles columns(column, tile_columns, across);
        for (int r = rows.first; r <= rows.last; ++r) {
          for (int c = columns.first; c <= columns.last; ++c) {
            const int tile = r * across + c;
            ++counts[static_cast<std::size_t>(tile) * bins_ + bin];
          }
        }
      };
      add(in_reference_, u);
      add(in_target_, u - static_cast<int>(std::lround(row[u] * inverse_factor)));
    }
  }
}

/// From the first to the last disparity that enough pixels of the tile agree on; all where too few pixels matched.
void TileRanges::choose(const std::vector<std::uint32_t>& counts, Image<SearchRanges::Range>& ranges, int factor,
                        int disparities) const {
  const int tile_pixels = (SearchRanges::tile_columns / factor) * (SearchRanges::tile_rows / factor);
  const auto fewest_pixels = static_cast<std::uint32_t>(tile_pixels / 20);
  constexpr double least_support = 0.003;
  const auto last = static_cast<int>(bins_) - 1;
  for (int tile = 0; tile < static_cast<int>(ranges.pixels()); ++tile) {
    const std::uint32_t* of_tile = counts.data() + static_cast<std::size_t>(tile) * bins_;
    std::uint32_t seen = 0;
    for (std::size_t d = 0; d < bins_; ++d) seen += of_tile[d];
    SearchRanges::Range& range = ranges(tile % ranges.width(), tile / ranges.width());
    if (seen < fewest_pixels) continue;
    const auto needed = std::max<std::uint32_t>(3, static_cast<std::uint32_t>(least_support * seen));
    // A disparity of the coarse pair stands for `factor` of them.
    const auto supported = [&](int d) {
      std::uint32_t sum = 0;
      for (int k = d; k < std::min(d + factor, last + 1); ++k) sum += of_tile[k];
      return sum >= needed;
    };
    int lowest = 0, highest = last;
    while (lowest < last && !supported(lowest)) ++lowest;
    while (highest > lowest && !supported(std::max(0, highest - factor + 1))) --highest;
    while (lowest < highest && of_tile[lowest] == 0) ++lowest;
    while (highest > lowest && of_tile[highest] == 0) --highest;
    int first = lowest - margin, end = highest + margin + 1;
    const int spare = (range_grid - (end - first) % range_grid) % range_grid;
    first -= spare / 2;
    end += spare - spare / 2;
    range.first = static_cast<std::int16_t>(std::clamp(first, 0, disparities - 1));
    range.end = static_cast<std::int16_t>(std::clamp(end, range.first + 1, disparities));
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

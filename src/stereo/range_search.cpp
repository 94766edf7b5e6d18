#include "stereo/range_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/shrink.hpp"

namespace roadstereo {
namespace {

constexpr int factor = 4;               // of the coarse look
constexpr int fewest_disparities = 12;  // below this there is nothing to save
constexpr int smallest_side = 128;      // pixels
constexpr int margin = 3;               // disparities beyond those seen
constexpr int overlap = 2;              // coarse pixels of the neighbouring tiles that count too
constexpr int range_grid = 8;           // ranges grow to multiples of this: vectors hold so many anyway

/// Coarse columns or rows of a tile.
constexpr int coarse_columns = SearchRanges::tile_columns / factor;
constexpr int coarse_rows = SearchRanges::tile_rows / factor;

/// First and last tile that a coarse column or row belongs to.
struct Tiles {
  int first, last;
  Tiles(int at, int size, int count)
      : first(std::clamp((at - overlap) / size, 0, count - 1)), last(std::clamp((at + overlap) / size, 0, count - 1)) {}
};

MatcherOptions coarse_options() {
  MatcherOptions options;
  options.block_radius = 3;
  options.aggregation_radius = 0;
  options.target_volume = false;
  options.drop_range_ends = false;
  return options;
}

}  // namespace

RangeSearch::RangeSearch(const std::string& engine, int threads) : engine_(make_engine(engine, threads)) {}

void RangeSearch::shrink_pair(const MatchInput& input) {
  for (GreyImage* small : {&reference_, &target_}) {
    small->resize(input.reference.width() / factor, input.reference.height() / factor);
  }
  shrink(input.reference, factor, reference_.view());
  shrink(input.target, factor, target_.view());
  first_column_.assign(static_cast<std::size_t>(reference_.height()), 0);
  if (input.first_column == nullptr) return;
  for (std::size_t v = 0; v < first_column_.size(); ++v) {
    const int* rows = input.first_column + factor * v;
    const int first = *std::max_element(rows, rows + factor);
    first_column_[v] = std::min(reference_.width(), (first + factor - 1) / factor);
  }
}

void RangeSearch::count_disparities() {
  const int across = ranges_.reference.width(), down = ranges_.reference.height();
  const std::size_t tiles = ranges_.reference.pixels();
  in_reference_.assign(tiles * bins_, 0);
  in_target_.assign(tiles * bins_, 0);
  for (int v = 0; v < maps_.disparity.height(); ++v) {
    const float* row = maps_.disparity.row(v);
    const Tiles rows(v, coarse_rows, down);
    for (int u = 0; u < maps_.disparity.width(); ++u) {
      if (std::isnan(row[u])) continue;
      const auto bin = std::min(bins_ - 1, static_cast<std::size_t>(std::max(0.0f, factor * row[u] + 0.5f)));
      const auto count = [&](std::vector<std::uint32_t>& counts, int column) {
        const Tiles columns(column, coarse_columns, across);
        for (int r = rows.first; r <= rows.last; ++r) {
          for (int c = columns.first; c <= columns.last; ++c) {
            ++counts[static_cast<std::size_t>(r * across + c) * bins_ + bin];
          }
        }
      };
      count(in_reference_, u);
      count(in_target_, u - static_cast<int>(std::lround(row[u])));
    }
  }
}

/// From the first to the last disparity that enough pixels of the tile agree on; all where too few pixels matched.
void RangeSearch::choose(const std::vector<std::uint32_t>& counts, Image<SearchRanges::Range>& ranges,
                         int disparities) const {
  constexpr std::uint32_t fewest_pixels = coarse_columns * coarse_rows / 20;
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
    while (highest > lowest && !supported(highest - factor + 1 < 0 ? 0 : highest - factor + 1)) --highest;
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

const SearchRanges* RangeSearch::find(const MatchInput& input) {
  const int width = input.reference.width(), height = input.reference.height();
  if (input.disparities < fewest_disparities || std::min(width, height) < smallest_side) return nullptr;
  shrink_pair(input);
  const int coarse_disparities = (input.disparities - 1) / factor + 2;
  engine_->match({reference_, target_, first_column_.data(), coarse_disparities}, coarse_options(), maps_);
  ranges_.assign(width, height, input.disparities);
  const int bins = coarse_disparities * factor;
  bins_ = static_cast<std::size_t>(bins);
  count_disparities();
  choose(in_reference_, ranges_.reference, input.disparities);
  choose(in_target_, ranges_.target, input.disparities);
  return &ranges_;
}

}  // namespace roadstereo

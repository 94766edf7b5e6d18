#include "stereo/cpu/cpu_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "stereo/cpu/view_matcher.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

using cpu::MatchView;
using cpu::Tile;
using cpu::ViewMatcher;

/// Left–right consistency (eq. lrc) and the sub-pixel disparity of one row. The shift of the perspective transformation
/// depends on the target pixel alone, so it cancels in the check.
void finish_row(int v, const MatcherOptions& options, MatchMaps& maps) {
  const std::int16_t* winner = maps.winner.row(v);
  const std::int16_t* target_winner = maps.target_winner.row(v);
  float* disparity = maps.disparity.row(v);
  for (int u = 0; u < maps.winner.width(); ++u) {
    const float offset = disparity[u];
    disparity[u] = std::numeric_limits<float>::quiet_NaN();
    if (winner[u] < 0) continue;
    if (options.left_right_check) {
      const double difference = winner[u] - target_winner[u - winner[u]];
      if (difference * difference > options.consistency) continue;
    }
    const bool bracketed = !std::isnan(offset);
    if (!bracketed && options.drop_range_ends) continue;
    disparity[u] = static_cast<float>(winner[u]) + (bracketed && options.sub_pixel ? offset : 0.0f);
  }
}

/// How an image is cut into tiles, so that every thread gets several.
struct Tiling {
  int columns, across;
  int rows, down;

  Tiling(const MatchInput& input, const MatcherOptions& options, int threads) {
    const int width = input.reference.width();
    const int height = input.reference.height();
    columns = ViewMatcher::tile_columns(input.disparities, options);
    across = (width + columns - 1) / columns;
    // A tile begins by filling its rings, so it should be high.
    const int halo = 2 * (options.block_radius + options.aggregation_radius);
    const int wanted = (4 * threads + 2 * across - 1) / (2 * across);
    rows = std::max(2 * halo, (height + wanted - 1) / wanted);
    down = (height + rows - 1) / rows;
  }

  int count() const { return across * down; }
  Tile tile(int i, int width, int height) const {
    const int row = i / across * rows;
    const int column = i % across * columns;
    return {row, std::min(row + rows, height), column, std::min(column + columns, width)};
  }
};

class CpuEngine final : public StereoEngine {
 public:
  explicit CpuEngine(int threads) : threads_(resolve_threads(threads)), matchers_(static_cast<std::size_t>(threads_)) {}

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    const int width = input.reference.width();
    const int height = input.reference.height();
    maps.winner.resize(width, height);
    maps.target_winner.resize(width, height);
    maps.disparity.resize(width, height);
    block_first_columns(input, options.block_radius, first_columns_);
    for (ViewMatcher& matcher : matchers_) matcher.prepare(input, options);
    const MatchView reference(input, MatchView::reference, first_columns_);
    const MatchView target(input, MatchView::target, first_columns_);
    const Tiling tiling(input, options, threads_);
    parallel_for(2 * tiling.count(), threads_, [&](int i, int worker) {
      const MatchView& view = i < tiling.count() ? reference : target;
      matchers_[static_cast<std::size_t>(worker)].match(view, tiling.tile(i % tiling.count(), width, height), maps);
    });
    parallel_rows(height, 32, threads_, [&](int first, int last, int) {
      for (int v = first; v < last; ++v) finish_row(v, options, maps);
    });
  }

 private:
  int threads_;
  std::vector<ViewMatcher> matchers_;
  std::vector<int> first_columns_;
};

}  // namespace

std::unique_ptr<StereoEngine> make_cpu_engine(int threads) {
  return std::make_unique<CpuEngine>(threads);
}

std::string cpu_engine_target() {
  return cpu::target_name();
}

}  // namespace roadstereo

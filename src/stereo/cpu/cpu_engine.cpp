#include "stereo/cpu/cpu_engine.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "stereo/adaptive_support.hpp"
#include "stereo/cpu/view_matcher.hpp"
#include "stereo/trim_window.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

using cpu::MatchView;
using cpu::Tile;
using cpu::ViewMatcher;

/// Left–right check, eq. (12), and sub-pixel disparity of row y of the maps.
void finish_row(int y, int pixel_step, const FinishSettings& settings, const Image<float>& offset, MatchMaps& maps) {
  const std::int16_t *winner = maps.winner.row(y), *target_winner = maps.target_winner.row(y);
  const float* offsets = offset.row(y);
  float *disparity = maps.disparity.row(y), *variance = maps.variance.row(y);
  for (int x = 0; x < maps.winner.width(); ++x) {
    const int met = winner[x] < 0 ? -1 : target_winner[x * pixel_step - winner[x]];
    disparity[x] = finish_disparity(winner[x], met, offsets[x], settings, variance[x]);
  }
}

/// A tile of one of the views.
struct Job {
  const MatchView* view;
  Tile tile;
};

/// Cuts a view into tiles that all search all disparities, so many that every thread gets several.
void cut_evenly(const MatchView& view, int columns, int disparities, const MatcherOptions& options, int threads,
                std::vector<Job>& jobs) {
  const int across = (view.width() + columns - 1) / columns;
  // A tile begins by filling its rings, so it should be high.
  const int halo = 2 * (block_row_radius(options) + options.aggregation_radius);
  const int wanted = (4 * threads + 2 * across - 1) / (2 * across);
  const int at_least = std::max(2 * halo, (view.height() + wanted - 1) / wanted);
  const int rows = at_least + at_least % options.pixel_step;  // a tile begins at a matched row
  for (int row = 0; row < view.height(); row += rows) {
    for (int column = 0; column < view.width(); column += columns) {
      jobs.push_back({&view,
                      {.first_row = row,
                       .last_row = std::min(row + rows, view.height()),
                       .first = column,
                       .end = std::min(column + columns, view.width()),
                       .range = {0, disparities}}});
    }
  }
}

/// Cuts a view into the tiles of its search ranges.
void cut_by_ranges(const MatchView& view, ImageView<const SearchRange> ranges, std::vector<Job>& jobs) {
  constexpr int columns = SearchRanges::tile_columns, rows = SearchRanges::tile_rows;
  const bool mirrored = view.side() == MatchView::target;
  for (int row = 0; row < ranges.height(); ++row) {
    for (int column = 0; column < ranges.width(); ++column) {
      const int first = column * columns, end = std::min(first + columns, view.width());
      const SearchRange& range = ranges(column, row);
      jobs.push_back({&view,
                      {.first_row = row * rows,
                       .last_row = std::min((row + 1) * rows, view.height()),
                       .first = mirrored ? view.width() - end : first,
                       .end = mirrored ? view.width() - first : end,
                       .range = {range.first, range.end - range.first}}});
    }
  }
}

class CpuEngine final : public StereoEngine {
 public:
  explicit CpuEngine(int threads) : threads_(resolve_threads(threads)), matchers_(static_cast<std::size_t>(threads_)) {}

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    use(options);
    const int width = input.reference.width();
    const int step = options.pixel_step;
    const int columns = matched_pixels(width, options), rows = matched_pixels(input.reference.height(), options);
    maps.winner.resize(columns, rows);
    maps.target_winner.resize(width, rows);
    maps.disparity.resize(columns, rows);
    maps.variance.resize(columns, rows);
    offset_.resize(columns, rows);
    block_first_columns(input, block_row_radius(options), first_columns_);
    const MatchView reference(input, MatchView::reference, first_columns_);
    const MatchView target(input, MatchView::target, first_columns_);
    const int whole_columns = std::min(ViewMatcher::tile_columns(input.disparities, options), width);
    jobs_.clear();
    for (const MatchView* view : {&reference, &target}) {
      if (view == &target && !options.match_both_views) continue;
      if (input.ranges.empty()) {
        cut_evenly(*view, whole_columns, input.disparities, options, threads_, jobs_);
      } else {
        cut_by_ranges(*view, view == &reference ? input.ranges.reference : input.ranges.target, jobs_);
      }
    }
    int tile_columns = 0, disparities = 0;
    for (const Job& job : jobs_) {
      tile_columns = std::max(tile_columns, job.tile.end - job.tile.first);
      disparities = std::max(disparities, job.tile.range.count);
    }
    prepare(tile_columns, disparities);
    parallel_for(static_cast<int>(jobs_.size()), threads_, [&](int i, int worker) {
      const Job& job = jobs_[static_cast<std::size_t>(i)];
      matchers_[static_cast<std::size_t>(worker)].match(*job.view, job.tile, maps, offset_);
    });
    const FinishSettings finish = finish_settings(options);
    parallel_rows(rows, 32, threads_, [&](int first, int last, int) {
      for (int y = first; y < last; ++y) {
        if (!options.match_both_views) project_winners(maps.winner, y, step, maps.target_winner);
        finish_row(y, step, finish, offset_, maps);
      }
    });
  }

 private:
  /// The weight of the prior differs from frame to frame in noise: nothing is prepared anew for that.
  void use(const MatcherOptions& options) {
    for (ViewMatcher& matcher : matchers_) matcher.set_prior(options);
    const MatcherOptions support = without_prior(options);
    if (options_ == support) return;
    options_.reset();  // until all is prepared
    prepared_columns_ = prepared_disparities_ = 0;
    taps_ = trimmed_taps(options);
    options_ = support;
  }

  /// Memory for the largest tile so far: frames that differ in their search ranges allocate nothing.
  void prepare(int columns, int disparities) {
    if (columns <= prepared_columns_ && disparities <= prepared_disparities_) return;
    const int most_columns = std::max(columns, prepared_columns_);
    const int most_disparities = std::max(disparities, prepared_disparities_);
    prepared_columns_ = prepared_disparities_ = 0;  // should memory run out
    for (ViewMatcher& matcher : matchers_) matcher.prepare(most_columns, most_disparities, *options_, taps_);
    prepared_columns_ = most_columns;
    prepared_disparities_ = most_disparities;
  }

  int threads_;
  std::optional<MatcherOptions> options_;  ///< that everything is prepared for
  std::vector<Tap> taps_;
  int prepared_columns_ = 0;
  int prepared_disparities_ = 0;
  std::vector<ViewMatcher> matchers_;
  std::vector<int> first_columns_;
  Image<float> offset_;  ///< sub-pixel disparity less the winner, pixels; NaN without two neighbours
  std::vector<Job> jobs_;
};

}  // namespace

std::unique_ptr<StereoEngine> make_cpu_engine(int threads) {
  return std::make_unique<CpuEngine>(threads);
}

std::string cpu_engine_target() {
  return cpu::target_name();
}

}  // namespace roadstereo

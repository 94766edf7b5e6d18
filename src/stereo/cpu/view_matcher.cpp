#include "stereo/cpu/view_matcher.hpp"

#include <algorithm>

#include "stereo/window.hpp"

namespace roadstereo::cpu {
namespace {

constexpr int no_taps = -1;  // a row that the window leaves out

}  // namespace

int ViewMatcher::tile_columns(int disparities, const MatcherOptions& options) {
  constexpr int cache_bytes = 512 * 1024;
  constexpr int min_columns = 64;
  const int step = options.pixel_step;
  const int ring = 2 * (options.aggregation_radius / step) + 1;
  const int bytes_per_column = (ring + 1) * disparities * static_cast<int>(sizeof(float));
  const int columns = cache_bytes / bytes_per_column - 2 * (options.aggregation_radius + options.block_radius) / step;
  return step * std::max(min_columns, columns / min_columns * min_columns);
}

void ViewMatcher::prepare(int columns, int disparities, const MatcherOptions& options, std::span<const Tap> taps) {
  pixel_step_ = options.pixel_step;
  radius_ = rows_ = 0;
  for (const Tap& tap : taps) {
    radius_ = std::max(radius_, tap.du / pixel_step_);
    rows_ = std::max(rows_, tap.dv / pixel_step_);
  }
  ring_ = 2 * rows_ + 1;
  step_ = std::max(1, options.aggregation_step / pixel_step_);
  half_widths_.assign(static_cast<std::size_t>(ring_), no_taps);
  for (const Tap& tap : taps) {
    int& half = half_width(tap.dv / pixel_step_);
    half = std::max(half, tap.du / options.aggregation_step);
  }
  const int padded = (matched(columns) + strip_columns - 1) / strip_columns * strip_columns;
  tile_costs_.prepare(padded + 2 * radius_, disparities, options);
  tile_weights_.prepare(padded, options, taps);
  const std::ptrdiff_t pitch = padded_disparities(disparities);
  costs_.resize(static_cast<std::size_t>(ring_), radius_ * pitch, (padded + radius_) * pitch);
  const AggregationScratchSize scratch = aggregation_scratch(ring_, static_cast<int>(taps.size()), pitch);
  scratch_.resize(1, 0, scratch.numbers);
  effective_samples_ = static_cast<float>(effective_samples(options));
  peak_floor_ = static_cast<float>(peak_floor(options));
  for (std::vector<float>* end : {&prior_low_, &prior_high_}) end->resize(static_cast<std::size_t>(padded));
  steps_.resize(static_cast<std::size_t>(scratch.pointers));
  winner_.resize(static_cast<std::size_t>(padded));
  offset_.resize(static_cast<std::size_t>(padded));
  variance_.resize(static_cast<std::size_t>(padded));
  window_.reserve(static_cast<std::size_t>(ring_));
}

void ViewMatcher::set_prior(const MatcherOptions& options) {
  prior_weight_ = static_cast<float>(options.prior_weight);
  prior_truncation_px_ = static_cast<float>(options.prior_truncation_px);
}

void ViewMatcher::match(const MatchView& view, const Tile& tile, MatchMaps& maps, Image<float>& offset) {
  const int first = tile.first_row / pixel_step_, last = matched(tile.last_row), rows = matched(view.height());
  const int columns = matched(tile.end - tile.first);
  int next = std::max(0, first - rows_);
  tile_costs_.start(view, next * pixel_step_, tile.first - radius_ * pixel_step_, columns + 2 * radius_, tile.range);
  tile_weights_.start(view, first, tile.first / pixel_step_, columns);
  for (int y = first; y < last; ++y) {
    for (; next <= std::min(rows - 1, y + rows_); ++next) {
      tile_costs_.compute(next * pixel_step_, cost_row(next) - radius_ * tile_costs_.pitch());
    }
    match_row(view, y, tile, maps, offset);
  }
}

void ViewMatcher::match_row(const MatchView& view, int y, const Tile& tile, MatchMaps& maps, Image<float>& offset) {
  const auto window_row = [&](int q) {
    return WindowRow{.costs = cost_row(q),
                     .half = half_width(q - y),
                     .first_visible = view.first_visible(q * pixel_step_) + tile.range.first - tile.first,
                     .last_valid = view.last_valid(q * pixel_step_) - tile.first};
  };
  window_.clear();
  for (int q = std::max(0, y - rows_); q <= std::min(matched(view.height()) - 1, y + rows_); ++q) {
    if (half_width(q - y) != no_taps) window_.push_back(window_row(q));
  }
  const AggregationRow row{.first = 0,
                           .end = matched(tile.end - tile.first),
                           .disparities = tile.range.count,
                           .pitch = tile_costs_.pitch(),
                           .pixel_step = pixel_step_,
                           .step = step_,
                           .radius = radius_,
                           .centre = window_row(y),
                           .rows = window_,
                           .weights = tile_weights_.compute(y),
                           .prior = prior_row(view, y, tile),
                           .effective_samples = effective_samples_,
                           .peak_floor = peak_floor_};
  const bool reference = view.side() == MatchView::reference;
  const auto original = [&](std::int16_t winner) {
    return static_cast<std::int16_t>(winner < 0 ? winner : winner + tile.range.first);
  };
  aggregate_and_choose(row, {steps_.data(), scratch_.row(0)},
                       {winner_.data(), reference ? offset_.data() : nullptr, variance_.data()});
  if (reference) {
    const int first = tile.first / pixel_step_;
    std::transform(winner_.data(), winner_.data() + row.end, maps.winner.row(y) + first, original);
    std::copy_n(offset_.data(), row.end, offset.row(y) + first);
    std::copy_n(variance_.data(), row.end, maps.variance.row(y) + first);
  } else {
    std::transform(winner_.rend() - row.end, winner_.rend(), maps.target_winner.row(y) + view.width() - tile.end,
                   original);
  }
}

/// The prior of row y, relative to the tile's first disparity.
PriorRow ViewMatcher::prior_row(const MatchView& view, int y, const Tile& tile) {
  const DisparityPriorView prior = view.prior();
  if (prior.disparity.empty() || prior_weight_ == 0) return {};
  const int v = std::min(y * pixel_step_ / prior.factor, prior.disparity.height() - 1);
  const float* const low = (prior.low.empty() ? prior.disparity : prior.low).row(v);
  const float* const high = (prior.high.empty() ? prior.disparity : prior.high).row(v);
  const auto first = static_cast<float>(tile.range.first);
  const int last_column = prior.disparity.width() - 1;
  for (int i = 0; i < matched(tile.end - tile.first); ++i) {
    const int u = std::min((tile.first + i * pixel_step_) / prior.factor, last_column);
    prior_low_[static_cast<std::size_t>(i)] = low[u] - first;
    prior_high_[static_cast<std::size_t>(i)] = high[u] - first;
  }
  return {.low = prior_low_.data(),
          .high = prior_high_.data(),
          .weight = prior_weight_,
          .truncation = prior_truncation_px_};
}

}  // namespace roadstereo::cpu

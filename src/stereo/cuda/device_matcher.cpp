#include "stereo/cuda/device_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereo/cuda/finish_rows.hpp"
#include "stereo/trim_window.hpp"
#include "stereo/window.hpp"

namespace roadstereo::cuda {
namespace {

/// Whether both have the same taps with the same weights by distance.
bool same_window(const MatcherOptions& a, const MatcherOptions& b) {
  return a.aggregation_radius == b.aggregation_radius && a.aggregation_aspect == b.aggregation_aspect &&
         a.aggregation_step == b.aggregation_step && a.aggregation_shape == b.aggregation_shape &&
         a.sigma_space == b.sigma_space;
}

}  // namespace

/// The window's taps with their weights by distance, on both sides of the bus.
void DeviceMatcher::make_taps(const MatcherOptions& options, StreamView stream) {
  stream.wait();  // what still reads the taps of before
  const std::vector<Tap> taps = trimmed_taps(options);
  taps_.reserve(taps.size());
  taps_on_device_.reserve(taps.size());
  settings_ = {};
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const double distance2 = taps[i].du * taps[i].du + taps[i].dv * taps[i].dv;
    const double log2_space = -distance2 / (options.sigma_space * options.sigma_space) * std::numbers::log2e;
    taps_.data()[i] = {static_cast<std::int16_t>(taps[i].du), static_cast<std::int16_t>(taps[i].dv),
                       static_cast<float>(log2_space)};
    settings_.window_half_width = std::max(settings_.window_half_width, taps[i].du);
    settings_.window_half_height = std::max(settings_.window_half_height, taps[i].dv);
  }
  settings_.taps = taps_on_device_.data();
  settings_.tap_count = static_cast<int>(taps.size());
  stream.upload(taps_on_device_.data(), taps_.data(), taps.size() * sizeof(WindowTap));
}

/// Block and prior follow the noise of every pair (adapt_support): that needs no wait.
void DeviceMatcher::use(const MatcherOptions& options, StreamView stream) {
  if (options_ == options) return;
  const bool same_taps = options_ && same_window(*options_, options);
  options_.reset();  // until all is made: memory may run out
  if (!same_taps) make_taps(options, stream);
  const double sigma_colour = options.sigma_colour * grey_scale, noise = options.ncc_noise_sigma * grey_scale;
  settings_.pixel_step = options.pixel_step;
  settings_.block_radius = options.block_radius;
  settings_.block_row_radius = block_row_radius(options);
  settings_.noise_variance = static_cast<float>(noise * noise);
  settings_.log2_colour = static_cast<float>(-std::numbers::log2e / (sigma_colour * sigma_colour));
  settings_.effective_samples = static_cast<float>(effective_samples(options));
  settings_.peak_floor = static_cast<float>(peak_floor(options));
  settings_.prior_weight = static_cast<float>(options.prior_weight);
  settings_.prior_truncation_px = static_cast<float>(options.prior_truncation_px);
  options_ = options;
}

void DeviceMatcher::reserve(int width, int height, int columns, int rows) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (std::size_t side = 0; side < 2; ++side) {
    column_sums_[side].reserve(pixels);
    blocks_[side].reserve(pixels);
    sums_.columns[side] = ImageView(column_sums_[side].data(), width, height);
    sums_.blocks[side] = ImageView(blocks_[side].data(), width, height);
  }
  first_columns_.reserve(static_cast<std::size_t>(height));
  sums_.first_columns = first_columns_.data();
  const std::size_t matched = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  offset_.reserve(matched);
  disparity_.reserve(matched);
  variance_.reserve(matched);
  winner_.reserve(matched);
  target_winner_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
  maps_ = {ImageView(disparity_.data(), columns, rows), ImageView(variance_.data(), columns, rows),
           ImageView(winner_.data(), columns, rows), ImageView(target_winner_.data(), width, rows)};
}

ViewToMatch DeviceMatcher::view_of(const MatchInput& input, bool mirrored) const {
  const std::size_t own = mirrored ? 1 : 0, other = 1 - own;
  ViewToMatch view{};
  view.own = mirrored ? input.target : input.reference;
  view.other = mirrored ? input.reference : input.target;
  view.own_columns = sums_.columns[own];
  view.other_columns = sums_.columns[other];
  view.own_blocks = sums_.blocks[own];
  view.other_blocks = sums_.blocks[other];
  view.first_column = first_columns_.data();
  view.mirrored = mirrored;
  view.disparities = input.disparities;
  view.ranges = mirrored ? input.ranges.target : input.ranges.reference;
  view.range_columns = SearchRanges::tile_columns;
  view.range_rows = SearchRanges::tile_rows;
  if (!mirrored && settings_.prior_weight > 0) {
    const DisparityPriorView& prior = input.prior;
    view.prior_low = prior.low.empty() ? prior.disparity : prior.low;
    view.prior_high = prior.high.empty() ? prior.disparity : prior.high;
  }
  view.prior_factor = input.prior.factor;
  return view;
}

const DeviceMatchMaps& DeviceMatcher::match(const MatchInput& input, const MatcherOptions& options, StreamView stream) {
  const int width = input.reference.width(), height = input.reference.height();
  use(options, stream);
  const int columns = matched_pixels(width, options), rows = matched_pixels(height, options);
  reserve(width, height, columns, rows);
  const ViewLaunch plan = plan_view_launch(settings_, width, height, input.disparities, multiprocessors_);
  const std::size_t energies = static_cast<std::size_t>(plan.blocks) * plan.energies_per_block;
  energies_.reserve(options.match_both_views ? 2 * energies : energies);
  reserve_cleared(drawn_, 2, stream.get());

  const ImageView<const std::int16_t> images[2]{input.reference, input.target};
  const ImageView offset(offset_.data(), columns, rows);
  sum_blocks(images, input.first_column, settings_.block_radius, settings_.block_row_radius, settings_.noise_variance,
             sums_, stream);
  const auto match_one = [&](std::size_t view, const ViewWinners& winners, const StreamView& in) {
    drawn_before_[view] +=
        match_view(view_of(input, view == 1), settings_, taps_.data(), plan, energies_.data() + view * energies,
                   {drawn_.data() + view, drawn_before_[view]}, winners, in);
  };
  // Where the blocks of one view come to their ends, those of the other begin.
  if (options.match_both_views) match_one(1, {maps_.target_winner, {}, {}}, target_branch_.fork(stream));
  match_one(0, {maps_.winner, offset, maps_.variance}, stream);
  if (options.match_both_views) target_branch_.join(stream);
  finish_rows(maps_.winner, maps_.target_winner, offset, finish_settings(options), !options.match_both_views,
              options.pixel_step, maps_.disparity, maps_.variance, stream);
  return maps_;
}

}  // namespace roadstereo::cuda

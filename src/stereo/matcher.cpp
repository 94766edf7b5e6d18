#include "roadstereo/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/max_disparities.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "roadstereo/error.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

void validate(ImageView<const SearchRange> ranges, const MatchInput& input, const char* view) {
  const int across = (input.reference.width() + SearchRanges::tile_columns - 1) / SearchRanges::tile_columns;
  const int down = (input.reference.height() + SearchRanges::tile_rows - 1) / SearchRanges::tile_rows;
  if (ranges.width() != across || ranges.height() != down) {
    fail("there are search ranges for ", ranges.width(), "×", ranges.height(), " tiles of the ", view,
         " image, which has ", across, "×", down);
  }
  for (int row = 0; row < down; ++row) {
    for (int column = 0; column < across; ++column) {
      const SearchRange& range = ranges(column, row);
      if (range.first < 0 || range.end <= range.first || range.end > input.disparities) {
        fail("the search range ", range.first, " … ", range.end, " of a tile of the ", view,
             " image is not within the disparities 0 … ", input.disparities);
      }
    }
  }
}

void validate(const DisparityPriorView& prior) {
  if (prior.factor < 1) fail("the prior's factor is ", prior.factor, "; it must be at least 1");
  for (const ImageView<const float>& end : {prior.low, prior.high}) {
    if (end.empty() && prior.low.empty() == prior.high.empty()) continue;
    require_same_size("the prior", map_size(prior.disparity), "an end of its intervals", map_size(end));
  }
}

}  // namespace

void MatcherOptions::validate() const {
  require_range("matcher", "block_radius", block_radius, 1, 10);
  require_range("matcher", "block_aspect", block_aspect, 0.1, 1.0);
  require_range("matcher", "aggregation_radius", aggregation_radius, 0, 10);
  require_range("matcher", "aggregation_aspect", aggregation_aspect, 0.1, 1.0);
  require_range("matcher", "aggregation_step", aggregation_step, 1, 2);
  require_range("matcher", "pixel_step", pixel_step, 1, 2);
  if (pixel_step == 2 && aggregation_radius > 0 && aggregation_step != 2) {
    fail("matcher.pixel_step is 2 and matcher.aggregation_step ", aggregation_step,
         "; both must be 2, or pixel_step 1");
  }
  if (pixel_step == 2 && match_both_views) {
    fail("matcher.pixel_step is 2 and matcher.match_both_views true; it must be false, or pixel_step 1");
  }
  require_range("matcher", "sigma_space", sigma_space, 0.1, 1000.0);
  require_range("matcher", "sigma_colour", sigma_colour, 0.1, 100000.0);
  require_range("matcher", "ncc_noise_sigma", ncc_noise_sigma, 0.0, 50.0);
  require_range("matcher", "prior_weight", prior_weight, 0.0, 100.0);
  require_range("matcher", "prior_truncation_px", prior_truncation_px, 0.0, 1000.0);
  require_range("matcher", "lr_max_diff_px", lr_max_diff_px, 0.0, 1024.0);
  require_range("matcher", "occlusion_sigma_px", occlusion_sigma_px, 0.0, 10.0);
}

void SearchRanges::assign(int width, int height, int disparities) {
  const int across = (width + tile_columns - 1) / tile_columns;
  const int down = (height + tile_rows - 1) / tile_rows;
  const SearchRange all{0, static_cast<std::int16_t>(disparities)};
  reference.assign(across, down, all);
  target.assign(across, down, all);
}

std::vector<Tap> window_taps(const MatcherOptions& options) {
  const int radius = options.aggregation_radius;
  const int step = options.aggregation_step;
  const double height = radius * options.aggregation_aspect;
  const int columns = radius / step * step, rows = static_cast<int>(height) / step * step;
  std::vector<Tap> taps;
  for (int dv = -rows; dv <= rows; dv += step) {
    for (int du = -columns; du <= columns; du += step) {
      const double across = du, down = dv / options.aggregation_aspect;
      if (options.aggregation_shape == WindowShape::square || across * across + down * down <= radius * radius) {
        taps.push_back({du, dv});
      }
    }
  }
  return taps;
}

double peak_floor(const MatcherOptions& options) {
  return options.peak_fit == PeakFit::gaussian ? 1 / std::sqrt(effective_samples(options)) : 0;
}

double effective_samples(const MatcherOptions& options) {
  const double width = 2 * options.block_radius + 1, height = 2 * block_row_radius(options) + 1;
  double weights = 0, squares_u = 0, squares_v = 0;
  for (const Tap& tap : window_taps(options)) {
    const double distance2 = tap.du * tap.du + tap.dv * tap.dv;
    const double weight = std::exp(-distance2 / (options.sigma_space * options.sigma_space));  // ω0
    weights += weight;
    squares_u += weight * tap.du * tap.du;
    squares_v += weight * tap.dv * tap.dv;
  }
  const auto spread = [&](double side, double squares) {
    return std::sqrt((side * side - 1) / 12 + squares / weights);
  };
  return std::max(width * height, 4 * std::numbers::pi * spread(width, squares_u) * spread(height, squares_v));
}

FinishSettings finish_settings(const MatcherOptions& options) {
  return {.left_right_check = options.left_right_check,
          .lr_max_diff_px = static_cast<float>(options.lr_max_diff_px),
          .occlusion_variance = static_cast<float>(options.occlusion_sigma_px * options.occlusion_sigma_px),
          .sub_pixel = options.sub_pixel,
          .reject_range_boundary = options.reject_range_boundary};
}

void block_first_columns(const MatchInput& input, int row_radius, std::vector<int>& first) {
  const int height = input.reference.height();
  first.assign(static_cast<std::size_t>(height), 0);
  if (input.first_column == nullptr) return;
  for (int v = 0; v < height; ++v) {
    const int* begin = input.first_column + std::max(0, v - row_radius);
    const int* end = input.first_column + std::min(height - 1, v + row_radius) + 1;
    first[static_cast<std::size_t>(v)] = *std::max_element(begin, end);
  }
}

void project_winners(const Image<std::int16_t>& winner, int y, int pixel_step, Image<std::int16_t>& target_winner) {
  const int width = target_winner.width();
  const std::int16_t* from = winner.row(y);
  std::int16_t* to = target_winner.row(y);
  std::fill_n(to, width, std::int16_t{-1});
  for (int x = 0; x < winner.width(); ++x) {
    if (from[x] < 0) continue;
    const int first = x * pixel_step - from[x];
    for (int t = first; t < std::min(first + pixel_step, width); ++t) to[t] = std::max(to[t], from[x]);
  }
}

void validate(const MatchInput& input) {
  if (input.reference.empty()) fail("matching needs an image, but the reference image is empty");
  require_same_size("the reference image", map_size(input.reference), "the target image", map_size(input.target));
  if (input.disparities < 1 || input.disparities > max_disparities) {
    fail("the number of disparities is ", input.disparities, "; it must be between 1 and ", max_disparities);
  }
  if (!input.ranges.empty()) {
    validate(input.ranges.reference, input, "reference");
    validate(input.ranges.target, input, "target");
  }
  validate(input.prior);
}

}  // namespace roadstereo

#include "stereo/cpu/tile_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereo/cpu/bilateral_weights.hpp"

namespace roadstereo::cpu {

void TileWeights::prepare(int columns, const MatcherOptions& options, std::span<const Tap> taps) {
  pixel_step_ = options.pixel_step;
  taps_.clear();
  log2_space_.clear();
  radius_ = 0;
  for (const Tap& tap : taps) {
    taps_.push_back({tap.du / pixel_step_, tap.dv / pixel_step_});
    radius_ = std::max(radius_, taps_.back().du);
    const double distance2 = tap.du * tap.du + tap.dv * tap.dv;
    log2_space_.push_back(
        static_cast<float>(-distance2 / (options.sigma_space * options.sigma_space) * std::numbers::log2e));
  }
  ring_ = radius_ + 1;
  const double sigma_colour = options.sigma_colour * grey_scale;
  log2_colour_ = static_cast<float>(-std::numbers::log2e / (sigma_colour * sigma_colour));
  const std::ptrdiff_t width = columns + 4 * radius_;
  samples_.resize(1, 0, width * pixel_step_);
  grey_.resize(static_cast<std::size_t>(ring_), 0, width);
  weights_.resize(static_cast<std::size_t>(ring_) * (taps_.size() / 2), 0, width);
  centre_.resize(1, 0, width);
  std::fill_n(centre_.row(0), width, 1.0f);
  row_.reserve(taps_.size());
}

void TileWeights::start(const MatchView& view, int y, int first, int columns) {
  view_ = &view;
  first_ = first - 2 * radius_;
  columns_ = columns + 4 * radius_;
  loaded_ = computed_ = std::max(0, y - radius_);
}

const float* TileWeights::grey_row(int y) {
  for (; loaded_ <= y; ++loaded_) {
    const std::int16_t* samples = samples_.row(0);
    view_->copy_own(loaded_ * pixel_step_, first_ * pixel_step_, columns_ * pixel_step_, samples_.row(0));
    float* grey = grey_.row(static_cast<std::size_t>(loaded_ % ring_));
    for (int k = 0; k < columns_; ++k) grey[k] = samples[std::ptrdiff_t{k} * pixel_step_];
  }
  return grey_.row(static_cast<std::size_t>(y % ring_));
}

/// The weights of row y for the taps behind the centre of the window.
void TileWeights::compute_behind(int y) {
  const std::size_t half = taps_.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const Tap& tap = taps_[half + 1 + i];
    if (y + tap.dv >= rows()) continue;
    float* weights = weights_.row(static_cast<std::size_t>(y % ring_) * half + i);
    const float* neighbour = grey_row(y + tap.dv) + tap.du;
    bilateral_weights(grey_row(y), neighbour, log2_space_[half + 1 + i], log2_colour_, radius_, columns_ - radius_,
                      weights);
  }
}

std::span<const float* const> TileWeights::compute(int y) {
  for (; computed_ <= y; ++computed_) compute_behind(computed_);
  const std::size_t half = taps_.size() / 2;
  row_.clear();
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    const Tap& tap = taps_[i];
    const int q = y + tap.dv;
    if (q < 0 || q >= rows()) continue;
    const float* weights = centre_.row(0);
    if (i > half) weights = weights_.row(static_cast<std::size_t>(y % ring_) * half + (i - half - 1));
    if (i < half) weights = weights_.row(static_cast<std::size_t>(q % ring_) * half + (half - 1 - i)) + tap.du;
    row_.push_back(weights + std::ptrdiff_t{2} * radius_);
  }
  return row_;
}

}  // namespace roadstereo::cpu

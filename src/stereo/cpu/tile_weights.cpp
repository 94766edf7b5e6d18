#include "stereo/cpu/tile_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereo/cpu/bilateral_weights.hpp"

namespace roadstereo::cpu {

void TileWeights::prepare(int columns, const MatcherOptions& options, std::span<const Tap> taps) {
  taps_.assign(taps.begin(), taps.end());
  radius_ = 0;
  for (const Tap& tap : taps_) radius_ = std::max(radius_, tap.du);
  ring_ = radius_ + 1;
  log2_space_.clear();
  for (const Tap& tap : taps_) {
    const double distance2 = tap.du * tap.du + tap.dv * tap.dv;
    log2_space_.push_back(
        static_cast<float>(-distance2 / (options.sigma_space * options.sigma_space) * std::numbers::log2e));
  }
  const double sigma_colour = options.sigma_colour * grey_scale;
  log2_colour_ = static_cast<float>(-std::numbers::log2e / (sigma_colour * sigma_colour));
  const std::ptrdiff_t width = columns + 4 * radius_;
  samples_.resize(1, 0, width);
  grey_.resize(static_cast<std::size_t>(ring_), 0, width);
  weights_.resize(static_cast<std::size_t>(ring_) * (taps_.size() / 2), 0, width);
  centre_.resize(1, 0, width);
  std::fill_n(centre_.row(0), width, 1.0f);
  row_.reserve(taps_.size());
}

void TileWeights::start(const MatchView& view, int v, int first, int columns) {
  view_ = &view;
  first_ = first - 2 * radius_;
  columns_ = columns + 4 * radius_;
  loaded_ = computed_ = std::max(0, v - radius_);
}

const float* TileWeights::grey_row(int v) {
  for (; loaded_ <= v; ++loaded_) {
    view_->copy_own(loaded_, first_, columns_, samples_.row(0));
    std::copy_n(samples_.row(0), columns_, grey_.row(static_cast<std::size_t>(loaded_ % ring_)));
  }
  return grey_.row(static_cast<std::size_t>(v % ring_));
}

/// The weights of row v for the taps behind the centre of the window.
void TileWeights::compute_behind(int v) {
  const std::size_t half = taps_.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const Tap& tap = taps_[half + 1 + i];
    if (v + tap.dv >= view_->height()) continue;
    float* weights = weights_.row(static_cast<std::size_t>(v % ring_) * half + i);
    const float* neighbour = grey_row(v + tap.dv) + tap.du;
    bilateral_weights(grey_row(v), neighbour, log2_space_[half + 1 + i], log2_colour_, radius_, columns_ - radius_,
                      weights);
  }
}

std::span<const float* const> TileWeights::compute(int v) {
  for (; computed_ <= v; ++computed_) compute_behind(computed_);
  const std::size_t half = taps_.size() / 2;
  row_.clear();
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    const Tap& tap = taps_[i];
    const int q = v + tap.dv;
    if (q < 0 || q >= view_->height()) continue;
    const float* weights = centre_.row(0);
    if (i > half) weights = weights_.row(static_cast<std::size_t>(v % ring_) * half + (i - half - 1));
    if (i < half) weights = weights_.row(static_cast<std::size_t>(q % ring_) * half + (half - 1 - i)) + tap.du;
    row_.push_back(weights + std::ptrdiff_t{2} * radius_);
  }
  return row_;
}

}  // namespace roadstereo::cpu

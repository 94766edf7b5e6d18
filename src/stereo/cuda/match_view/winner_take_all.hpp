#pragma once

#include "stereo/cuda/match_view/tile.hpp"
#include "stereo/sub_pixel.hpp"

// Winner-take-all with the prior, and sub-pixel offset, of one pixel.

namespace roadstereo::cuda {

/// The energies of one thread's pixel, one for every disparity of its range.
class PixelEnergies {
 public:
  __device__ PixelEnergies(float* of_block, const SearchRange& range)
      : values_(of_block + threadIdx.x), first_(range.first), end_(range.end) {}

  __device__ int first() const { return first_; }
  __device__ int end() const { return end_; }
  __device__ float operator()(int d) const { return values_[std::ptrdiff_t{d - first_} * threads]; }
  __device__ void set(int d, float energy) {
    if (d < end_) values_[std::ptrdiff_t{d - first_} * threads] = energy;
  }

 private:
  float* values_;
  int first_, end_;
};

/// Winner-take-all: the disparity of the smallest energy plus what the prior asks for; −1 where there is none.
__device__ inline int take_winner(const ViewToMatch& view, const ViewSettings& settings, const PixelEnergies& energies,
                                  int u, int v) {
  float smallest = INFINITY;
  int winner = -1;
  for (int d = energies.first(); d < energies.end(); ++d) {
    const float energy = energies(d);
    if (energy < smallest) {
      smallest = energy;
      winner = d;
    }
  }
  if (view.prior_low.empty() || winner < 0) return winner;
  const int x = min(u / view.prior_factor, view.prior_low.width() - 1);
  const int y = min(v / view.prior_factor, view.prior_low.height() - 1);
  const float low = view.prior_low(x, y), high = view.prior_high(x, y);
  if (!(low == low)) return winner;
  const float weight = settings.prior_weight * prior_share(smallest);
  float best = INFINITY;
  for (int d = energies.first(); d < energies.end(); ++d) {
    const float regularised =
        energies(d) + prior_cost(weight, settings.prior_truncation_px, low, high, static_cast<float>(d));
    if (regularised < best) {
      best = regularised;
      winner = d;
    }
  }
  return winner;
}

__device__ inline void choose(const ViewToMatch& view, const ViewSettings& settings, const PixelEnergies& energies,
                              int u, int v, const ViewWinners& winners) {
  const int winner = take_winner(view, settings, energies, u, v);
  const int x = u / settings.pixel_step, y = v / settings.pixel_step;
  winners.winner(x, y) = static_cast<std::int16_t>(winner);
  if (winners.offset.empty()) return;
  SubPixel sub_pixel{NAN, INFINITY};
  const bool bracketed = winner > energies.first() && winner + 1 < energies.end() && energies(winner + 1) < INFINITY;
  if (bracketed) {
    sub_pixel = fit_peak(energies(winner - 1), energies(winner), energies(winner + 1), settings.effective_samples,
                         settings.peak_floor);
  }
  winners.offset(x, y) = sub_pixel.offset;
  winners.variance(x, y) = sub_pixel.variance;
}

}  // namespace roadstereo::cuda

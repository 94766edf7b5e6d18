#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// A few places in an image of `width`×`height` pixels, and the weights of the coefficients around each.
class SplinePlaces {
 public:
  static constexpr int max_count = 64;

  SplinePlaces(int width, int height);
  /// Sets the places (x[k], y[k]). Those beyond the outermost pixels are moved onto them.
  void set(const float* x, const float* y, int count);

 private:
  friend class SplineImage;
  static constexpr std::size_t taps = 4;
  using Weights = std::array<std::array<float, max_count>, taps>;

  int width_, height_, count_ = 0;
  std::array<int, max_count> first_{};  ///< index of the first of the 4×4 coefficients
  Weights across_{}, down_{};
};

/// Cubic B-spline through the samples of a channel of a frame, continued by reflection at its outermost pixels
/// (M. Unser, Splines: A Perfect Fit for Signal and Image Processing, 1999). It displaces texture of up to half of the
/// Nyquist frequency by at most 0.002 px, where convolution with a cubic displaces it by 0.02 to 0.05 px.
class SplineImage {
 public:
  /// Of at least 2×2 pixels.
  SplineImage(const FrameView& frame, int channel, int threads);

  /// Values at places of this image, within the range of its samples.
  void sample(const SplinePlaces& places, float* values) const;

 private:
  int width_, height_;
  float darkest_ = 0, brightest_ = 0;
  std::vector<float> coefficients_;  ///< with a margin of one on each side
};

}  // namespace roadstereo
#pragma GCC visibility pop

#pragma once

#include "roadstereo/image.hpp"
#include "roadstereo/transformed_pair.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Options of the Lucas–Kanade step.
struct LucasKanadeOptions {
  int radius = 2;  ///< of the square window, cells of 4×4 pixels, 0 … 8: 2 is 20×20 pixels; 0 switches the step off
  double bias_sigma_px = 0.03;  ///< expected size of the correction (standard deviation of its prior), pixels,
                                ///< 0.001 … 10; with a larger one less noise is suppressed
  double max_shift_px = 0.5;    ///< largest change of a disparity, pixels, 0.01 … 2

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const LucasKanadeOptions&) const = default;
};

/// One Gauss–Newton step of Lucas and Kanade ("An iterative image registration technique", 1981) for every cell of 4×4
/// pixels, interpolated between cells: the change that makes the target, sampled at the disparities of all pixels of a
/// window, equal to the reference up to a gain and an offset. It removes the rest of pixel locking, which pulls the
/// residual disparity of fine texture towards whole pixels, and part of the smoothing by the matching window, since
/// every pixel of the window is compared at its own disparity. The change is shrunk according to its variance, so that
/// it is small where the image is noisy.
///
/// `disparity`: of the original images, W×H, pixels, NaN invalid. Writes `aligned`, W×H, NaN where `disparity` is.
/// Throws Error when the sizes differ.
void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned);

}  // namespace roadstereo
#pragma GCC visibility pop

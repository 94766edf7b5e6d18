#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Mean signed disparity error by sub-pixel phase of the true disparity: the pixel-locking bias of a matcher. Errors
/// larger than one pixel are mismatches and are excluded.
class SubPixelBias {
 public:
  /// Splits the phase 0 … 1 into `bins` equal bins. Throws Error when there are fewer than 2.
  explicit SubPixelBias(int bins = 20);

  /// Add the pixels where the mask is not 0 and both maps are finite. Throws Error when the sizes differ.
  void add(ImageView<const float> disparity, ImageView<const float> truth, ImageView<const std::uint8_t> mask);

  std::vector<double> phases() const;    ///< centre of each bin
  std::vector<double> means_px() const;  ///< mean error (map − truth) of each bin, pixels; NaN for an empty bin
  double ripple_px() const;              ///< peak-to-peak of the means, pixels; NaN if all bins are empty

 private:
  struct Bin {
    double sum_px = 0;
    double count = 0;
  };
  std::vector<Bin> bins_;
};

}  // namespace roadstereo

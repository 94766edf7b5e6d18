#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Mean signed error against the sub-pixel phase of the true disparity: how much a matcher favours whole disparities.
/// Gross errors, larger than a pixel, say nothing of that and are left out.
class SubPixelBias {
 public:
  /// `bins` equal parts of the phase 0 … 1. Throws Error when there are fewer than 2 of them.
  explicit SubPixelBias(int bins = 20);

  /// Counts the pixels where the mask is not 0 and both maps are finite. Throws Error when sizes differ.
  void add(ImageView<const float> disparity, ImageView<const float> truth, ImageView<const std::uint8_t> mask);

  std::vector<double> phases() const;    ///< middle of each bin
  std::vector<double> means_px() const;  ///< mean error (map − truth) of each bin, pixels; NaN when it has no pixel
  double ripple_px() const;              ///< largest less smallest of the means; NaN when no bin has a pixel

 private:
  struct Bin {
    double sum_px = 0;
    double count = 0;
  };
  std::vector<Bin> bins_;
};

}  // namespace roadstereo

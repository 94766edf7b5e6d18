#pragma once

#include <vector>

#include "roadstereo/matcher.hpp"
#include "stereo/coarse/pixel_height.hpp"

namespace roadstereo {

/// Scratch memory of find_prior_intervals.
struct IntervalScratch {
  std::vector<float> smallest, largest;  ///< of the pixels above and below, with as many as the radius on either side

  void reserve(int columns, int radius) {
    const std::size_t padded = static_cast<std::size_t>(columns) + 2 * static_cast<std::size_t>(radius);
    for (std::vector<float>* of : {&smallest, &largest}) of->reserve(padded);
  }
};

/// Rows first ≤ v < last of prior.low and prior.high, which have the size of its map. `radius`: that of the blocks,
/// coarse pixels.
void find_prior_intervals(const PerspectiveShift& shift, const PixelHeight& heights, int radius, int first, int last,
                          IntervalScratch& scratch, DisparityPrior& prior);

}  // namespace roadstereo

#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "road/cuda/fitted_plane.hpp"
#include "road/plane_search.hpp"
#include "roadstereo/image_view.hpp"

// Block matching along a known plane by normalised cross-correlation, on the device.

namespace roadstereo::cuda {

/// The pair as the search sees it, at 1 / factor of its size.
struct GuidedPair {
  ImageView<const std::int16_t> left, right;
  int factor;
};

/// What was found, in device memory: place by place of the grid, so in the host's order. Full-size coordinates.
struct GuidedSlots {
  float* u;
  float* v;
  float* d;            ///< NaN where nothing was matched
  float* correlation;  ///< highest, however low, where it lies within a pixel of the plane; else NaN
  int* tried;          ///< 1: the place has texture and both views see it
};

/// match_along_plane() on the device, around a plane in full-size coordinates; a warp for each place. Where `needed`,
/// in device memory, is 0, nothing is tried.
void match_along_plane(const GuidedPair& pair, const SampleGrid& grid, const PlaneSource& plane, const int* needed,
                       const GuidedSlots& slots, StreamView stream);

}  // namespace roadstereo::cuda

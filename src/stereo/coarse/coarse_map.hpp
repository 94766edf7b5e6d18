#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Vertical median of five rows, which removes streaks: the scanlines are optimised independently. NaN stays, and so do
/// pixels with a NaN among the five. Writes the rows [first, last) of `smoothed`, which has the size of `map`.
void median_of_rows(const Image<float>& map, int first, int last, Image<float>& smoothed);

/// Fills the occluded pixels of a row with the disparity of their farther neighbour. A pixel is occluded when another
/// one with more than one pixel more of disparity projects onto the same target pixel. `disparity`: pixels of the map,
/// NaN unknown. `nearest` is scratch memory.
void fill_occlusions(float* disparity, int columns, std::vector<float>& nearest);

}  // namespace roadstereo

#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// The map with every disparity replaced by the median of five rows: paths along the rows know nothing of the rows
/// above and below, and a path that went astray is a streak one row high. NaN stays, and so does what has a NaN among
/// the five. Fills the rows [first, last) of `smoothed`, which has the size of `map`.
void median_of_rows(const Image<float>& map, int first, int last, Image<float>& smoothed);

/// Gives what the target view does not see the disparity of its farther neighbour along the row. A pixel is hidden when
/// another one with more than one pixel more of disparity lies on the same target pixel; nothing can match it, so that
/// its path goes anywhere. `disparity`: one row, in pixels of the map, NaN unknown. `nearest` is scratch memory.
void fill_occlusions(float* disparity, int columns, std::vector<float>& nearest);

}  // namespace roadstereo

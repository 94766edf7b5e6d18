#pragma once

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/search_range.hpp"

namespace roadstereo::cuda {

/// Tiles of the full-size pair, and their size in coarse pixels.
struct CoarseTiles {
  int across, down;
  int columns, rows;
};

/// Writes to `reference` and `target`, one element a tile and row by row, the range of the disparities of the coarse
/// map (full-size pixels, NaN unknown) in each tile of either view, with a margin; all where too few pixels matched.
void find_tile_ranges(ImageView<const float> coarse, int factor, int disparities, const CoarseTiles& tiles,
                      SearchRange* reference, SearchRange* target, StreamView stream);

}  // namespace roadstereo::cuda

#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "stereo/block_correlation.hpp"

namespace roadstereo::cuda {

/// Sums over the rows of a block at one column: of the grey values less mid-grey, and of their squares.
/// Aligned, so that both are read at once.
struct alignas(8) ColumnSums {
  int sum;
  int squares;
};

/// The blocks of both views, "means and deviations once": what a cost needs besides the products.
struct BlockSums {
  ImageView<ColumnSums> columns[2];  ///< over the rows of a block, per column of each view
  ImageView<BlockPart> blocks[2];    ///< of the whole blocks; of no meaning where one leaves the image's columns
  int* first_columns;  ///< for every row v the first target column that all rows of the block around v see
};

/// Fills `sums` for the two images of a pair. `first_column` is that of every row of the target, null where every row
/// sees all.
void sum_blocks(const ImageView<const std::int16_t> (&images)[2], const int* first_column, int block_radius,
                int row_radius, float noise_variance, const BlockSums& sums, StreamView stream);

}  // namespace roadstereo::cuda

#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/unroll.hpp"
#include "core/mid_grey.hpp"
#include "stereo/cuda/match_view/tile.hpp"

// Grey levels of both views around a tile, in shared memory.

namespace roadstereo::cuda {

/// Grey levels less mid-grey, 0 where there is no pixel: of the own view under the blocks of the halo, of the other
/// view what those can match at `disparities` disparities from `first_disparity` on.
class StagedPixels {
 public:
  static constexpr int disparities = 32;  ///< a multiple of the chunk

  /// `memory` has room for bytes() of them.
  __device__ StagedPixels(const Halo& halo, int row_radius, void* memory)
      : rows_(rows_of(halo, row_radius)),
        own_columns_(halo.product_columns),
        other_columns_(halo.product_columns + disparities - 1),
        own_(static_cast<short*>(memory)),
        other_(own_ + rows_ * own_columns_) {}

  ROADSTEREO_HD static std::size_t bytes(const Halo& halo, int row_radius) {
    const int columns = 2 * halo.product_columns + disparities - 1;
    return sizeof(short) * static_cast<std::size_t>(rows_of(halo, row_radius) * columns);
  }

  __device__ void load_own(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile) {
    load(view, view.own, own_, own_columns_, tile.halo_i - settings.block_radius,
         tile.halo_v - settings.block_row_radius);
  }
  __device__ void load_other(const ViewToMatch& view, const ViewSettings& settings, const Tile& tile,
                             int first_disparity) {
    first_disparity_ = first_disparity;
    load(view, view.other, other_, other_columns_,
         tile.halo_i - settings.block_radius - first_disparity - (disparities - 1),
         tile.halo_v - settings.block_row_radius);
  }

  __device__ int own_columns() const { return own_columns_; }
  __device__ int other_columns() const { return other_columns_; }
  /// Column `column` of the blocks from row `row` on, and its counterpart at disparity d.
  __device__ const short* own(int row, int column) const { return own_ + row * own_columns_ + column; }
  __device__ const short* other(int row, int column, int d) const {
    return other_ + row * other_columns_ + column + disparities - 1 - (d - first_disparity_);
  }

 private:
  ROADSTEREO_HD static int rows_of(const Halo& halo, int row_radius) {
    return (halo.rows - 1) * halo.step + 1 + 2 * row_radius;
  }

  /// A warp to a row, whose pixels are on their way together: memory takes long.
  __device__ void load(const ViewToMatch& view, const ImageView<const std::int16_t>& image, short* to, int columns,
                       int first_i, int first_v) const {
    constexpr int at_once = 4;
    const int lane = static_cast<int>(threadIdx.x) % warp_lanes, width = image.width();
    for (int row = static_cast<int>(threadIdx.x) / warp_lanes; row < rows_; row += threads / warp_lanes) {
      const int v = first_v + row;
      const bool inside = v >= 0 && v < image.height();
      const std::int16_t* greys = image.row(inside ? v : 0);
      for (int first = lane; first < columns; first += at_once * warp_lanes) {
        int grey[at_once];
        ROADSTEREO_UNROLL
        for (int k = 0; k < at_once; ++k) {
          const int i = first_i + first + k * warp_lanes;
          grey[k] = inside && i >= 0 && i < width ? __ldg(greys + image_column(view, i)) : mid_grey;
        }
        ROADSTEREO_UNROLL
        for (int k = 0; k < at_once; ++k) {
          const int column = first + k * warp_lanes;
          if (column < columns) to[row * columns + column] = static_cast<short>(grey[k] - mid_grey);
        }
      }
    }
  }

  int rows_, own_columns_, other_columns_;
  int first_disparity_ = 0;
  short *own_, *other_;
};

}  // namespace roadstereo::cuda

#pragma once

#include "damage/candidates.hpp"
#include "damage/outline.hpp"
#include "damage/view_gaps.hpp"

namespace roadstereo {

/// Label of a cell deeper or higher than a damage can be; damage keeps clear of it.
inline constexpr std::uint8_t obstacle_label = 3;

/// Label of a cell that belongs to a damage; 0: none.
inline std::uint8_t label_of(DamageKind kind) {
  return kind == DamageKind::depression ? 1 : 2;
}

/// Confidence from which a region is rather a damage than none.
inline constexpr double even_confidence = 0.5;

/// Inputs of the search.
struct SearchInput {
  DepthCells& depth_cells;  ///< `remove_outliers` changes it
  const Image<std::uint8_t>& road;
  const CommonView& view;
  const Ruts& ruts;
  const ViewGaps& gaps;
  const SurfaceCoordinates& coordinates;
  const Thresholds& thresholds;
  const ImageEdges& image_edges;
};

/// Images of the search for one kind of damage, of one size.
struct SearchImages {
  Image<float>& depth;                  ///< positive inside this kind of damage
  const Image<std::uint8_t>& allowed;   ///< 255 where a cell may belong to a damage
  Image<std::uint8_t>& visited;         ///< scratch of flood fills
  const Image<std::uint8_t>& assigned;  ///< `label_of` the damage that the cell belongs to, `obstacle_label`, or 0
  CellBox labels_read;                  ///< box around the cells whose `assigned` was read

  DepthField field() { return {depth, allowed, visited}; }
  const Image<std::uint8_t>& labels(const CellBox& box) {
    labels_read.add(box);
    return assigned;
  }
};

}  // namespace roadstereo

#pragma once

#include "damage/common_view.hpp"
#include "damage/depth_cells.hpp"
#include "damage/thresholds.hpp"

namespace roadstereo {

/// Gaps of the view, where there is no measurement. Masks of the cells.
struct ViewGaps {
  Image<std::uint8_t> known;   ///< 0 in gaps of the view
  Image<std::uint8_t> deep;    ///< 255 in gaps that belong to a depression
  Image<std::uint8_t> unseen;  ///< 255 in other gaps that touch its border: what is not seen, or off road
  Image<std::uint8_t> hidden;  ///< 255 in those and under the mask: the picture shows no road there
};

/// Find the gaps, and which of them belong to a depression or lie at the border.
ViewGaps classify_gaps(const DepthCells& cells, const CommonView& view, const Thresholds& thresholds);

}  // namespace roadstereo

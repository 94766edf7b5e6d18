#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// The connected regions (by sides and corners) of a label, specks of fewer than 50 pixels left out.
struct LabelRegions {
  Image<int> ids;                  ///< 1, 2, …; 0 outside
  std::vector<std::size_t> sizes;  ///< pixels of region k + 1
};
LabelRegions label_regions(const Image<std::uint8_t>& label);

}  // namespace roadstereo::cli

#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Connected components of a label with 8-connectivity; components of fewer than 50 pixels are ignored.
struct LabelRegions {
  Image<int> ids;                  ///< 1, 2, …; 0 outside
  std::vector<std::size_t> sizes;  ///< pixels of region k + 1
};
LabelRegions label_regions(const Image<std::uint8_t>& label);

}  // namespace roadstereo::cli

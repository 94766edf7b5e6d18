#pragma once

#include <algorithm>
#include <cmath>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// Rows of the block N⁺ above and below its centre.
inline int block_row_radius(const MatcherOptions& options) {
  return std::max(1, static_cast<int>(std::lround(options.block_radius * options.block_aspect)));
}

}  // namespace roadstereo

#pragma once

#include "road/transformed.hpp"

// Spread of a row of the transformed disparity, with vector instructions.

namespace roadstereo {

/// Sums of the residuals of a row.
struct RowSpread {
  Spread all{}, road{};  ///< of the road: those whose magnitude is at most a limit
};

/// Residuals are those from `delta_t`.
RowSpread spread_of_row(const float* row, int width, double delta_t, double limit);

}  // namespace roadstereo

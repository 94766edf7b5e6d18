#pragma once

#include <span>

#include "roadstereo/alignment.hpp"

namespace roadstereo {

/// Line of the vertical offsets, by iteratively reweighted least squares (IRLS) with Tukey weights. Slopes that are not
/// significant are left out, and so is an offset that is not.
RowOffset fit_row_offset(std::span<const RowSample> samples);

}  // namespace roadstereo

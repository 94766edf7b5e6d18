#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/cell_levels.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Cells of a view that never move while the rest of the picture does and that hang together with its border: 255, the
/// others 0. Nothing when less moves than is still: the vehicle stood, and something passed by.
/// `max_variance_ratio`: of StaticMaskOptions.
std::optional<Image<std::uint8_t>> find_still_cells(const CellLevels& levels, double max_variance_ratio);

}  // namespace roadstereo

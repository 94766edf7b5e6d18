#pragma once

namespace roadstereo {

/// Larger values of a map, of either sign, are none, such as −3.4e38 for no data: sums of their squares would overflow.
inline constexpr float max_map_value = 1e15F;

}  // namespace roadstereo

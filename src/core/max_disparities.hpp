#pragma once

namespace roadstereo {

/// The most disparities that a matcher searches.
inline constexpr int max_disparities = 1024;

}  // namespace roadstereo

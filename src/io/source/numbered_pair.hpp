#pragma once

#include <cstdint>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

/// Returns a pair without views: its index, the index in six digits as name, and its time since the first pair; NaN if
/// `rate_hz` is 0.
SourcePair numbered_pair(std::int64_t index, double rate_hz);

}  // namespace roadstereo::io

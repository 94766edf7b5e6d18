#pragma once

#include <cstdint>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

/// A pair that has its place, the place as its name in six digits, and its time from the first pair on; no time when
/// `rate_hz` is 0. The views are still empty.
SourcePair numbered_pair(std::int64_t index, double rate_hz);

}  // namespace roadstereo::io

#pragma once

#include "roadstereo/matcher.hpp"

namespace roadstereo::cpu {

/// The same options with a window that leaves out the taps which carry next to no weight: together at most a thousandth
/// of Σ ω0. With the paper's σ0 = 1.5 the disc of radius 4, 49 taps, stands for the square of 121.
MatcherOptions trim_window(const MatcherOptions& options);

}  // namespace roadstereo::cpu

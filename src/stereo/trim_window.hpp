#pragma once

#include <vector>

#include "stereo/window.hpp"

namespace roadstereo {

/// Returns the taps of the aggregation window without those of negligible weight: a disc whose outside holds at most
/// half a thousandth of Σ ω0. With the paper's σ0 = 1.5, 57 taps stand for the square of 121.
std::vector<Tap> trimmed_taps(const MatcherOptions& options);

}  // namespace roadstereo

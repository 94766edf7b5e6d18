#pragma once

#include <vector>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// One neighbour of the aggregation window: its offset from the centre.
struct Tap {
  int du;
  int dv;
};

/// The pixels q of the window N⁺ around a pixel, row by row.
std::vector<Tap> window_taps(int radius, WindowShape shape);

/// Throws Error when the images of `input` differ in size or D is out of range.
void validate(const MatchInput& input);

}  // namespace roadstereo

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
std::vector<Tap> window_taps(const MatcherOptions& options);

/// For every row v the first target column that all rows of the block around v see: blocks are rectangles, so the
/// common view of a block begins there.
void block_first_columns(const MatchInput& input, int block_radius, std::vector<int>& first);

/// Row v of the target's winners from those of the reference: the nearest of several hides the others.
void project_winners(const Image<std::int16_t>& winner, int v, Image<std::int16_t>& target_winner);

/// Throws Error when the images of `input` differ in size or D is out of range.
void validate(const MatchInput& input);

}  // namespace roadstereo

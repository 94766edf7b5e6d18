#pragma once

#include <vector>

#include "roadstereo/matcher.hpp"
#include "stereo/finish_disparity.hpp"
#include "stereo/sub_pixel.hpp"

namespace roadstereo {

/// One neighbour of the aggregation window: its offset from the centre.
struct Tap {
  int du;
  int dv;
};

/// The pixels q of the window N⁺ around a pixel, row by row.
std::vector<Tap> window_taps(const MatcherOptions& options);

/// Number of independent pixels that an aggregated cost rests on: the block and the window (without the colour weights,
/// which are not known beforehand) together spread over it like a Gaussian of the variance s² = s²_block + s²_window
/// per axis, and a Gaussian mean has the noise of 4π s² pixels.
///
/// The variance of a disparity follows from its aggregated costs E. A block of n pixels with signal variance S and
/// noise variance N per view has E = N / (S + N) at the right disparity, and its curvature along d is K = Σ(∂i/∂u)² /
/// (n (S + N)). The disparity of least squares has the variance 2 N / Σ(∂i/∂u)² = 2 E / (n K). A winner that is no
/// minimum of the costs adds the distance from the vertex of the parabola to the reach of eq. (13).
double effective_samples(const MatcherOptions& options);

/// For every row v the first target column that all rows of the block around v see: blocks are rectangles, so the
/// common view of a block begins there.
void block_first_columns(const MatchInput& input, int block_radius, std::vector<int>& first);

/// Row v of the target's winners from those of the reference: the nearest of several hides the others.
void project_winners(const Image<std::int16_t>& winner, int v, Image<std::int16_t>& target_winner);

/// Settings of finish_disparity.
FinishSettings finish_settings(const MatcherOptions& options);

/// Throws Error when the images of `input` differ in size or D is out of range.
void validate(const MatchInput& input);

}  // namespace roadstereo

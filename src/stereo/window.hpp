#pragma once

#include <vector>

#include "core/block_row_radius.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/finish_disparity.hpp"
#include "stereo/sub_pixel.hpp"

namespace roadstereo {

/// Tap of the aggregation window: its offset from the centre, pixels.
struct Tap {
  int du;
  int dv;
};

/// Returns the taps of the aggregation window, row by row.
std::vector<Tap> window_taps(const MatcherOptions& options);

/// Returns the number of independent pixels behind an aggregated cost. Block and window (without the colour weights)
/// together spread it like a Gaussian of the variances s² = s²_block + s²_window along rows and columns, and a Gaussian
/// mean has the noise of 4π s_u s_v pixels.
///
/// The variance of a disparity follows from its aggregated costs E. A block of n pixels with signal variance S and
/// noise variance N per view has E = N / (S + N) at the right disparity, and its curvature along d is K = Σ(∂i/∂u)² /
/// (n (S + N)). The least-squares disparity has the variance 2 N / Σ(∂i/∂u)² = 2 E / (n K). Where the winner is no
/// minimum of the costs, the squared distance of the vertex of the parabola from the truncated offset of eq. (13) is
/// added.
double effective_samples(const MatcherOptions& options);

/// Returns what a Gaussian peak adds to the correlations before their logarithm, see `fit_peak`; 0: a parabola.
double peak_floor(const MatcherOptions& options);

/// Writes for every row v the first target column that is valid in all rows of the block around v, from v − row_radius
/// on: blocks are rectangles, so that the common view of a block begins there.
void block_first_columns(const MatchInput& input, int row_radius, std::vector<int>& first);

/// Pixels that are matched, of `pixels` along a side.
inline int matched_pixels(int pixels, const MatcherOptions& options) {
  return (pixels + options.pixel_step - 1) / options.pixel_step;
}

/// Projects row y of the reference's winners into the target view, each with the pixels up to the next; the largest
/// disparity wins.
void project_winners(const Image<std::int16_t>& winner, int y, int pixel_step, Image<std::int16_t>& target_winner);

/// Settings of finish_disparity.
FinishSettings finish_settings(const MatcherOptions& options);

/// Throws Error when the images of `input` differ in size or D is out of range.
void validate(const MatchInput& input);

}  // namespace roadstereo

#pragma once

#include <vector>

#include "roadstereo/disparity_score.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/sub_pixel_bias.hpp"

namespace roadstereo::cli {

/// Scores by group and by method.
struct SynthScores {
  std::vector<std::vector<DisparityScore>> whole;   ///< over what both cameras see
  std::vector<std::vector<DisparityScore>> damage;  ///< over the damage alone
};

/// Mean error against the phase of the true disparity for the default preset and SGBM, and bars of e_p+ of every group.
/// `biases` has one entry per method.
Frame synth_figure(const std::vector<SubPixelBias>& biases, const SynthScores& scores,
                   const std::vector<double>& tolerances_px);

}  // namespace roadstereo::cli

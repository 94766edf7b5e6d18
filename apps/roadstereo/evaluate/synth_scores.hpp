#pragma once

#include <vector>

#include "evaluate/methods.hpp"
#include "evaluate/synth_groups.hpp"
#include "roadstereo/disparity_score.hpp"
#include "roadstereo/sub_pixel_bias.hpp"

namespace roadstereo::cli {

/// Scores by group and by method, means over the scenes of the group.
using ScoresByGroup = std::vector<std::vector<DisparityScore>>;

/// Over which pixels the rendered pairs are scored.
struct SynthScores {
  ScoresByGroup visible;             ///< what both cameras see
  ScoresByGroup damage;              ///< the damage alone
  ScoresByGroup common;              ///< what both cameras see and every method but BM gives
  ScoresByGroup common_damage;       ///< the same on the damage
  std::vector<SubPixelBias> biases;  ///< of the clean pairs, one per method
};

/// Tolerances of the scores, pixels.
const std::vector<double>& synth_tolerances_px();

/// Matches every scene of every group with every method.
SynthScores score_synth(const std::vector<synth::Scene>& scenes, const MethodSettings& settings);

}  // namespace roadstereo::cli

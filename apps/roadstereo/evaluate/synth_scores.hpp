#pragma once

#include <vector>

#include "evaluate/methods.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluation/disparity_score.hpp"
#include "evaluation/sub_pixel_bias.hpp"

namespace roadstereo::cli {

/// Scores by group and method, means over the scenes of the group.
using ScoresByGroup = std::vector<std::vector<DisparityScore>>;

/// Scores over different sets of pixels.
struct SynthScores {
  ScoresByGroup visible;             ///< pixels that both cameras see
  ScoresByGroup damage;              ///< those on damage
  ScoresByGroup common;              ///< visible pixels with a disparity of every method except BM
  ScoresByGroup common_damage;       ///< those on damage
  std::vector<SubPixelBias> biases;  ///< of the clean pairs, one per method
};

/// Tolerances of the scores, pixels.
const std::vector<double>& synth_tolerances_px();

/// Match every scene of every group with every method.
SynthScores score_synth(const std::vector<synth::Scene>& scenes, const MethodSettings& settings);

}  // namespace roadstereo::cli

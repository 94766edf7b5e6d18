#pragma once

#include "evaluate/synth_scores.hpp"

namespace roadstereo::cli {

/// Mean error against the phase of the true disparity for the default preset and SGBM, and bars of e_p+ of every group.
Frame synth_figure(const SynthScores& scores);

}  // namespace roadstereo::cli

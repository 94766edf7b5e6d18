#pragma once

#include <string>

#include "evaluate/synth_scores.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// Group by group and figure by figure: "best" where the default preset is no worse than any of OpenCV's matchers, else
/// the best of them with its figure and ours. The other presets are no peers.
struct SynthVerdict {
  Table table;
  std::string summary;  ///< one line: how many groups and figures are won
};

/// `kind` names the pixels, e.g. "damage". `common` are the scores over the pixels that every method gives; e_r, which
/// says nothing of missing disparities, is compared there too.
SynthVerdict judge_default(const std::string& kind, const ScoresByGroup& scores, const ScoresByGroup& common);

}  // namespace roadstereo::cli

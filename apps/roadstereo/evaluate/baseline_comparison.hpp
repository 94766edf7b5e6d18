#pragma once

#include <string>

#include "evaluate/synth_scores.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// Comparison of the default preset with OpenCV's matchers.
struct BaselineComparison {
  Table table;  ///< by group and measure: "best" if no matcher is better, else the best matcher and both values; "–"
                ///< without a value of the default preset
  std::string summary;  ///< one line: number of groups in which the default preset is best
};

/// Compare the default preset with OpenCV's matchers. `pixels` names the set of pixels. `common` are the scores over
/// the pixels with a disparity of every method, on which e_r, which ignores missing disparities, is also compared.
BaselineComparison compare_with_baselines(const std::string& pixels, const ScoresByGroup& scores,
                                          const ScoresByGroup& common);

}  // namespace roadstereo::cli

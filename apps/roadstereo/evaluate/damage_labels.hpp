#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "evaluate/region_score.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// Depressions found against the labels of one frame.
struct LabelResult {
  std::string frame;
  RegionScore score;
  std::size_t labelled = 0;  ///< regions of the label
  std::size_t hit = 0;       ///< ... that a depression covers by a third
  std::size_t invented = 0;  ///< depressions of which less than a third is labelled
  std::size_t measured = 0;  ///< labelled pixels that have a disparity
};

/// Transformed maps with labels: DIR/disp_tg, DIR/label, DIR/rgb (may be missing). Throws Error naming what is missing.
std::vector<LabelResult> score_labelled_maps(const std::string& folder);

/// Stereo pairs with labels, as `find_scan_frames` finds them.
std::vector<LabelResult> score_labelled_pairs(const std::string& folder, const std::string& preset);

/// One row per frame and one for all pixels.
Table label_table(const std::vector<LabelResult>& results);

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "evaluate/damage_method.hpp"
#include "evaluate/damage_regions.hpp"
#include "evaluate/region_score.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// Depressions of one frame compared with its labels.
struct LabelResult {
  std::string method, frame;
  RegionScore score;                ///< pixels
  std::size_t labels = 0;           ///< connected components of the label
  std::size_t found = 0;            ///< labels that depressions cover by at least a third
  std::size_t false_positives = 0;  ///< depressions of which less than a third is labelled
  std::size_t measured = 0;         ///< labelled pixels with a disparity
  std::vector<FoundRegion> regions;
};

/// Score transformed maps with labels: folder/disp_tg, folder/label, and folder/rgb if present. Throws Error naming the
/// file that is missing.
std::vector<LabelResult> score_labelled_maps(const std::string& folder);

/// Score stereo pairs with labels, in the layout of `find_labelled_pairs`, by every method.
std::vector<LabelResult> score_labelled_pairs(const std::string& folder, const std::vector<DamageMethod>& methods);

/// Table with one row per method and frame, and one per method for all pixels. Results are grouped by method.
Table label_table(const std::vector<LabelResult>& results);

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct AblationOptions {
  std::string kitti;  ///< folder laid out as KITTI Stereo 2015; empty leaves those columns out
  std::string sizes = "small";
  MethodSettings methods;
};

/// What one variant reaches. NaN without the frames for it.
struct AblationFigures {
  double kitti_density = 0, kitti_rms_px = 0;            ///< inside the road masks, means over the frames
  double kitti_bad = 0, kitti_bad_or_missing = 0;        ///< e_p(2), e_p+(2), shares
  double clean_median_px = 0, clean_bad_or_missing = 0;  ///< rendered, unspoilt: median |error|, e_p+(1)
  double hard_bad_or_missing = 0;                        ///< rendered, mean over the spoilt groups: e_p+(1)
  double damage_rms_px = 0, damage_bad_or_missing = 0;   ///< rendered, mean over all groups, on damage: e_r, e_p+(0.5)
  double match_ms = 0, total_ms = 0;                     ///< medians over the frames
};

/// Matches every frame with every variant, one frame after the other, so that all variants see the same machine. What
/// is scored is a pair that is seen for the first time; what is timed is the same pair once more, with the memory there
/// and the road model carried over. Times are KITTI's where there is a folder, else those of the clean rendered pairs.
std::vector<AblationFigures> measure_ablation(const AblationOptions& options);

}  // namespace roadstereo::cli

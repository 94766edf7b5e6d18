#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct AblationOptions {
  std::string kitti;  ///< folder with the layout of KITTI Stereo 2015; empty: no KITTI columns
  std::string sizes = "small";
  MethodSettings methods;
};

/// Accuracy and times of one variant. NaN if there are no frames for a value.
struct AblationResult {
  double kitti_density = 0, kitti_rms_px = 0;            ///< inside the road masks, means over the frames
  double kitti_bad = 0, kitti_bad_or_missing = 0;        ///< e_p(2), e_p+(2), shares
  double clean_median_px = 0, clean_bad_or_missing = 0;  ///< rendered without degradation: median |error|, e_p+(1)
  double hard_bad_or_missing = 0;                        ///< rendered, mean over the degraded groups: e_p+(1)
  double damage_rms_px = 0, damage_bad_or_missing = 0;   ///< rendered, on damage, mean over all groups: e_r, e_p+(0.5)
  double match_ms = 0, total_ms = 0;                     ///< medians over the frames
};

/// Match every frame with every variant, frame by frame, so that all variants run under the same load. The first match
/// of a pair is scored; the second is timed, with memory allocated and the road model tracked. Times are those of the
/// KITTI frames if there is a folder, else those of the clean rendered pairs.
std::vector<AblationResult> measure_ablation(const AblationOptions& options);

}  // namespace roadstereo::cli

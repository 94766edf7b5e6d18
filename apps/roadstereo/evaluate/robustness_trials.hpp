#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "evaluate/robustness_sources.hpp"
#include "evaluation/disparity_score.hpp"

namespace roadstereo::cli {

/// Names of the compared methods: the default preset, then OpenCV's matchers.
const std::vector<std::string>& robustness_methods();

/// Tolerances of the scores, pixels.
const std::vector<double>& robustness_tolerances_px();

/// One labelled pair, without state from other pairs.
struct RobustnessTrial {
  std::string frame;
  RoadStatus status = RoadStatus::none;  ///< none, too, if the pair was rejected
  double plane_px = 0;  ///< largest difference of the plane before matching to that of the truth, over the pixels of
                        ///< the road; infinite without a road
  std::vector<DisparityScore> scores;  ///< over the road, by method

  /// Whether this trial is worse: no road found, else more errors above 1 px (missing ones are errors).
  bool worse_than(const RobustnessTrial& other) const;
};

/// A trial and its maps.
struct RobustnessResult {
  RobustnessTrial trial;
  std::vector<Image<float>> maps;  ///< disparities, by method
};

/// Run every method on a labelled pair.
RobustnessResult run_robustness_trial(const std::string& name, const LabelledFrame& frame,
                                      const MethodSettings& settings);

/// Counts over a drive.
struct DriveCounts {
  int frames = 0;
  int tracked = 0;
  int found = 0;  ///< anew, the first frame included
  int none = 0;   ///< rejected frames included
  int damages = 0;
};

/// Run the default preset over a drive, state carried over.
DriveCounts run_drive(const Drive& drive, const MethodSettings& settings);

}  // namespace roadstereo::cli

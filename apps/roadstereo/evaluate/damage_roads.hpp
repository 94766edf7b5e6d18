#pragma once

#include <string>
#include <vector>

#include "evaluate/region_score.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// What is found on intact road.
struct RoadResult {
  std::string frame;
  RegionScore road;             ///< the road region against the mask, over the pixels that have a truth
  std::size_t depressions = 0;  ///< false ones: the road is intact
  std::size_t protrusions = 0;
};

/// KITTI frames with masks of the road. Throws Error naming the frame whose mask is missing.
std::vector<RoadResult> score_intact_roads(const std::string& folder, const std::string& preset);

/// One row per frame, and the means.
Table road_table(const std::vector<RoadResult>& results);

}  // namespace roadstereo::cli

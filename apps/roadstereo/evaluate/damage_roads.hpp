#pragma once

#include <string>
#include <vector>

#include "evaluate/damage_method.hpp"
#include "evaluate/damage_regions.hpp"
#include "evaluate/region_score.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {

/// Road region and damage found on intact road.
struct RoadResult {
  std::string method, frame;
  RegionScore road;             ///< road region against the mask, over the pixels with a ground truth
  std::size_t depressions = 0;  ///< false positives, since the road is intact
  std::size_t protrusions = 0;  ///< false positives
  std::vector<FoundRegion> regions;
};

/// Score KITTI frames with road masks by every method. Throws Error naming the frame whose mask is missing.
std::vector<RoadResult> score_intact_roads(const std::string& folder, const std::vector<DamageMethod>& methods);

/// Table with one row per method and frame, and the means by method. Results are grouped by method.
Table road_table(const std::vector<RoadResult>& results);

}  // namespace roadstereo::cli

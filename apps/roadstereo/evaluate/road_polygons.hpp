// Road regions drawn by hand: polygons in JSON.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/polygon_mask.hpp"

namespace roadstereo::cli {

/// Read polygons by frame: {"000003_10": [[[u, v], …], …], …}, pixels of the left image. Throws Error naming the file
/// and the frame whose polygons are not lists of at least three corners within ±100000 px.
std::map<std::string, std::vector<Polygon>> read_road_polygons(const std::string& path);

}  // namespace roadstereo::cli

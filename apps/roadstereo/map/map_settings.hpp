#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "map/map_plan.hpp"
#include "processing_options.hpp"
#include "roadstereo/road_map.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// Command line options of `map`.
struct MapSettings {
  std::vector<std::string> source;      ///< recordings and outputs of `inspect`, or left and right of one recording
  std::vector<std::string> trajectory;  ///< one file per recording; outputs have theirs
  std::vector<std::string> day;         ///< empty: by the times of the frames; or one name per recording
  std::vector<std::string> calibration;
  std::string output;
  std::string crs;    ///< of the trajectories, whose z axis then points up; empty: cameras
  double cell_m = 0;  ///< 0: from the first frame
  std::int64_t every = 1;
  bool points = false;  ///< whether to write points.ply
  bool las = false;     ///< whether to write points.las
  bool resume = false;  ///< continues a map that was interrupted
  ProcessingSettings processing;
  SourceSettings source_settings;
  bool quiet = false;
  bool json = false;

  /// Throws Error naming the first option out of range.
  void validate() const;

  /// Checks and parses the options. Throws Error naming the first that is unknown or out of range.
  MapPlan plan() const;
};

}  // namespace roadstereo::cli

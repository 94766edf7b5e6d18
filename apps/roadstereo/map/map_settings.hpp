#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "processing_options.hpp"
#include "roadstereo/road_map.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// Command line options of `map`.
struct MapSettings {
  std::vector<std::string> source;      ///< one recording per trajectory, or left and right of one
  std::vector<std::string> trajectory;  ///< one file per recording
  std::vector<std::string> calibration;
  std::string output;
  std::string crs;    ///< of the trajectories, whose z axis then points up; empty: cameras
  double cell_m = 0;  ///< 0: from the first frame
  std::int64_t every = 1;
  bool points = false;  ///< whether to write points.ply
  ProcessingSettings processing;
  SourceSettings source_settings;
  bool quiet = false;
  bool json = false;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

}  // namespace roadstereo::cli

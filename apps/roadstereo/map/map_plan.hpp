#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// A recording of a map and its poses.
struct MapPass {
  std::vector<std::string> source;  ///< one name, or left and right
  SourceSettings source_settings;
  std::vector<std::string> calibration;  ///< empty: that of the source
  std::string trajectory;                ///< file of the poses
  std::int64_t from = 0;             ///< frames that should have a pose, of a run those that it processed: the first
  std::optional<std::int64_t> to{};  ///< the last one; absent: the end
  std::int64_t every = 1;            ///< every N-th of them
  std::string crs;                   ///< of the poses of a run; empty: none, or unknown
  PipelineOptions options;
  bool find_white_level = true;  ///< determines it from the pairs of a 16-bit source
  Image<std::uint8_t> mask;      ///< not 0 left out; empty: none
  std::string day;               ///< empty: by the time of its first good pair
  double time_offset_s = 0;      ///< added to the times of the frames
};

/// Options of a map that need no parsing.
struct MapOptions {
  std::string crs;    ///< of the trajectories, whose z axis then points up; empty: cameras
  double cell_m = 0;  ///< 0: from the first frame
  std::int64_t every = 1;
  bool points = false;  ///< whether to write points.ply
  bool las = false;     ///< whether to write points.las
  bool resume = false;  ///< continues a map that was interrupted
  bool quiet = false;
};

/// Checked options of a map.
struct MapPlan : MapOptions {
  std::vector<MapPass> passes;  ///< at least one; the damage options of the first are those of the map
  std::filesystem::path output;
};

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "map/map_plan.hpp"
#include "processing_options.hpp"
#include "roadstereo/road_map.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// Command line options of `map`.
struct MapSettings : MapOptions {
  std::vector<std::string> source;      ///< recordings and outputs of `inspect`, or left and right of one recording
  std::vector<std::string> trajectory;  ///< one file per recording; outputs have theirs
  std::vector<std::string> day;         ///< empty: by the times of the frames; or one name per recording
  std::vector<std::string> calibration;
  std::string output;
  ProcessingSettings processing;
  bool sets_severity = false;  ///< instead of that of the runs
  SourceSettings source_settings;
  bool json = false;

  /// Throws Error naming the first option out of range.
  void validate() const;

  /// Checks and parses the options. Throws Error naming the first that is unknown or out of range.
  MapPlan plan() const;
};

}  // namespace roadstereo::cli

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pair_source.hpp"
#include "report_head.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// One inspected pair: inputs, settings and results.
struct Inspection {
  PairFiles files;
  ReportHead head;
  StereoPair pair;
  std::string mask_file;      ///< empty: none
  Image<std::uint8_t> mask;   ///< not 0 left out; empty: none
  std::string rig_bias_file;  ///< empty: none
  std::string preset;
  PipelineOptions options;
  std::string engine;  ///< name of the engine used; empty with a given disparity map
  int threads = 0;     ///< number of threads used
  FrameResult result;
  DamageMap damage;
  PairHealth health;
  std::optional<GroundPlane> plane;                                  ///< metric; needs a calibration and a road
  std::vector<std::string> warnings;                                 ///< of the pipeline and of the command
  std::vector<std::pair<std::string, std::string>> files_written{};  ///< name, what it is
};

}  // namespace roadstereo::cli

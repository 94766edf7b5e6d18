#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pair_source.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// One inspected pair: what went in, how it was treated, what came out.
struct Inspection {
  PairFiles files;
  StereoPair pair;
  std::string preset;
  PipelineOptions options;
  std::string engine;  ///< the engine that ran
  int threads = 0;     ///< the threads it ran on
  FrameResult result;
  DamageMap damage;
  std::optional<GroundPlane> plane;   ///< in space; only with a calibration and a road
  std::vector<std::string> warnings;  ///< the pipeline's and the command's own
};

}  // namespace roadstereo::cli

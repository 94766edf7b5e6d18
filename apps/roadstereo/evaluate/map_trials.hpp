#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/map_inventory.hpp"
#include "roadstereo/pose_graph.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

struct MapTrialOptions {
  int roads = 1;
  int frames = 30;  ///< of each of the three passes
  std::uint64_t seed = 1;
  std::string preset = "default";
  int threads = 0;
  bool estimated_poses = false;  ///< those of odometry, loops and positions instead of the true ones

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Heights of two passes over one road.
struct PassDifference {
  double rms_m = 0;        ///< of the difference
  double predicted_m = 0;  ///< RMS of its standard error
  std::size_t cells = 0;
};

/// One true damage and its records.
struct MapDamageTrial {
  synth::DamageTruth truth;
  int records = 0;                ///< of all passes; 1 is right
  RoadDamageRecord record;        ///< the first one
  double best_frame_error_m = 0;  ///< of the depth in the frame with the smallest standard error
};

/// Results over all roads.
struct MapTrials {
  std::vector<PassDifference> forward;  ///< second pass against the first
  std::vector<PassDifference> reverse;  ///< pass in the other direction against the first
  std::vector<MapDamageTrial> damages;
  int false_records = 0;               ///< of no true damage
  int frames_without_road = 0;         ///< of all passes, not mapped
  std::vector<double> single_sigma_m;  ///< of each road, median standard error of a height, one frame
  std::vector<double> fused_sigma_m;   ///< and of the map of all passes
  std::vector<LoopLink> loops;         ///< with estimated poses
};

/// Renders roads with random potholes and bumps that a rig flies over three times, the third time in the other
/// direction, maps them, and compares. Throws Error for options out of range.
MapTrials run_map_trials(const MapTrialOptions& options);

/// Growth of the peak memory of this process while a map of `frames` more frames, 0.5 m apart, is made, MiB. The first
/// fifth of the frames is not counted.
double map_memory_growth_mib(int frames);

}  // namespace roadstereo::cli

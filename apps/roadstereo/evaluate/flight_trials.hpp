#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cli {

struct FlightOptions {
  std::string scene = "uav";
  std::string size = "640x360";
  std::string flight = "default";
  std::string preset = "default";
  int frames = 300;
  int supersampling = 1;  ///< rays per pixel and axis of the renderer
  bool cold = false;      ///< whether the first frame allocates memory and starts threads
  int passes = 5;         ///< number of times each frame is timed, 1 … 100
  MethodSettings methods;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Error of a road plane. Infinite if no road was found.
struct RoadError {
  double roll_rad = 0;  ///< |error of ψ|; NaN if the camera looks straight down
  double plane_px = 0;  ///< maximum difference from the true plane over the image below the horizon
};

/// Errors of the road model before matching and of the plane after it.
struct StageErrors {
  RoadError before;
  RoadError after;
};

struct FlightTrial {
  StageErrors tracked;           ///< of the pipeline that processed the previous frames
  StageErrors fresh;             ///< of a pipeline that was reset
  bool reestimated = false;      ///< whether the tracking pipeline re-estimated the road model
  std::string reason;            ///< for the re-estimation
  std::vector<double> times_ms;  ///< one per pass
  std::vector<double> cpu_ms;    ///< of all threads, one per pass
};

/// Render the flight and process it frame by frame: by one tracking pipeline per pass, which all have processed the
/// same frames, so that a frame is timed several times in the same state, and by a pipeline that is reset before each
/// frame.
std::vector<FlightTrial> run_flight_trials(const FlightOptions& options);

}  // namespace roadstereo::cli

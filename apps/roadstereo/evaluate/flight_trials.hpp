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
  int supersampling = 1;  ///< rays per pixel and side of the renderer
  bool cold = false;      ///< the first frame also makes the pipeline's memory and starts its threads
  int passes = 5;         ///< how often each frame is timed
  MethodSettings methods;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// How far a road model is from the truth.
struct RoadError {
  double roll_rad = 0;  ///< |ψ − its true value|; NaN where the camera looks straight down
  double plane_px = 0;  ///< largest difference to the true plane over the image below the horizon
};

/// What one way of starting a frame led to: before matching and after it.
struct FlightResult {
  RoadError before;
  RoadError after;
};

struct FlightFrame {
  FlightResult carried;          ///< by the pipeline that saw the frames before
  FlightResult fresh;            ///< by one that has seen nothing
  bool estimated_anew = false;   ///< by the first
  std::string reason;            ///< why, when it was
  std::vector<double> times_ms;  ///< of the frame: one per pass
  std::vector<double> cpu_ms;    ///< of all threads: one per pass
};

/// Renders the flight frame by frame. Every frame goes through as many pipelines as there are passes, which all have
/// seen the same frames before, so that each frame is timed several times in one and the same state; and through one
/// that starts afresh.
std::vector<FlightFrame> fly(const FlightOptions& options);

}  // namespace roadstereo::cli

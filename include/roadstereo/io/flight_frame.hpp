#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::io {

/// What became of a frame of a flight.
enum class FrameStatus {
  good,     ///< matched
  refused,  ///< the source had no pair: unreadable, no partner, views taken too far apart
  failed    ///< the pair could not be matched
};
const char* name_of(FrameStatus status);

/// One frame of a flight: all that its tables, its report and its continuation need, and no maps. NaN is unknown.
struct FlightFrame {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t index = 0;   ///< place in the source, from 0
  std::string name;         ///< as the source names it
  double time_s = unknown;  ///< since 1970, or since the source's start
  FrameStatus status = FrameStatus::good;
  std::string reason;                              ///< why it is not good
  bool road_reliable = false;                      ///< the road was found before matching
  bool road_tracked = false;                       ///< ... from the frame before; else it was estimated anew
  double roll_rad = unknown;                       ///< ψ
  double roll_stderr_rad = unknown;                ///< its standard error
  bool roll_observable = false;                    ///< false when the camera looks straight down
  double alpha0 = unknown;                         ///< pixels
  double alpha1 = unknown;                         ///< pixels per pixel
  DisparityPlane road{unknown, unknown, unknown};  ///< after matching
  double height_m = unknown;                       ///< of the camera over the road, when calibrated
  double pitch_rad = unknown;                      ///< of the optical axis below the road's horizon, when calibrated
  double sigma_d_px = unknown;                     ///< spread of the transformed disparities over the road
  double valid_share = unknown;                    ///< share of the pixels that have a disparity
  double noise_px = unknown;                       ///< of the intact road
  double matching_ms = unknown;                    ///< time in the pipeline
  double damage_ms = unknown;                      ///< time in finding and measuring damage
  std::vector<Damage> damages;                     ///< deepest first
  std::vector<std::string> warnings;
  double white_level = 0;  ///< sample value of white that the frame was taken with; 0 is the largest of the sample type
  PipelineState carried;   ///< what the next frame starts from
};

/// One line of JSON without a line end; numbers are read back to the same bits.
std::string flight_frame_json(const FlightFrame& frame);

/// Reads what `flight_frame_json` wrote. Throws Error saying what is missing or of another kind.
FlightFrame read_flight_frame(const std::string& json);

}  // namespace roadstereo::io

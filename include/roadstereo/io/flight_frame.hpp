#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/rigid_transform.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Result of processing one frame of a flight.
enum class FrameStatus {
  good,      ///< matched
  rejected,  ///< the source returned no valid pair: unreadable, unpaired, or views too far apart in time
  failed     ///< matching failed
};
const char* name_of(FrameStatus status);

/// Result of StaticMask for a flight.
struct StaticMaskRecord {
  bool judged = false;     ///< whether the decision was made (StaticMask::judged)
  std::int64_t frame = 0;  ///< frame of the decision, index in the source
  double share = 0;        ///< share of the image that never moves, 0 … 1
  bool applied = false;    ///< whether that part is masked from that frame on
};

/// Where the camera of a frame was, by odometry.
struct FlightPose {
  int piece = 0;  ///< piece of the motion; places of different pieces are not related
  RigidTransform road_to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< 3×4, row-major, metres: `road_axes` of
                                                                     ///< this frame to the first camera of
                                                                     ///< the piece
};

/// Record of one frame of a flight, without its maps. NaN: unknown.
struct FlightFrame {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t index = 0;   ///< index in the source, from 0
  std::string name;         ///< as the source names it
  double time_s = unknown;  ///< since 1970, or since the start of the source
  FrameStatus status = FrameStatus::good;
  std::string reason;                              ///< why `status` is not good
  RoadStatus road_status = RoadStatus::none;       ///< of the road model before matching
  double roll_rad = unknown;                       ///< ψ
  double roll_stderr_rad = unknown;                ///< standard error of ψ
  bool roll_observable = false;                    ///< false if the camera looks straight down
  double alpha0 = unknown;                         ///< pixels
  double alpha1 = unknown;                         ///< pixels per pixel
  DisparityPlane road{unknown, unknown, unknown};  ///< after matching
  double height_m = unknown;                       ///< height of the camera above the road; needs a calibration
  double pitch_rad = unknown;                      ///< optical axis below the road's horizon; needs a calibration
  double height_stderr_m = unknown;                ///< `ground_plane_error`
  double pitch_stderr_rad = unknown;
  double sigma_d_px = unknown;                     ///< standard deviation of the transformed disparities on the road
  double valid_share = unknown;                    ///< fraction of pixels with a disparity
  double noise_px = unknown;                       ///< of the intact road
  double matching_ms = unknown;                    ///< time in Pipeline::process
  double damage_ms = unknown;                      ///< time in find_damage
  std::optional<FlightPose> pose;                  ///< absent without a calibration or a road
  std::vector<std::array<double, 2>> footprint_m;  ///< `road_footprint`; empty without a calibration
  PairHealth health;
  std::optional<RigBiasFrame> rig_bias;  ///< contribution of the frame to the rig bias (measure_rig_bias)
  std::vector<Damage> damages;           ///< deepest first
  std::vector<Damage> candidates;        ///< `DamageMap::candidates`
  std::vector<std::string> warnings;
  double white_level = 0;        ///< sample value of white; 0: maximum of the sample type
  PipelineState pipeline_state;  ///< state of the pipeline after this frame
  StaticMaskRecord static_mask;  ///< state at this frame
};

/// Returns the text as it is written to JSON files: every byte that is not valid UTF-8 is replaced by U+FFFD.
std::string valid_utf8(const std::string& text);

/// Returns one line of JSON without a line end. Numbers are read back bit for bit.
std::string flight_frame_json(const FlightFrame& frame);

/// Parses the output of `flight_frame_json`. Throws Error naming the field that is missing or has the wrong type.
FlightFrame read_flight_frame(const std::string& json);

}  // namespace roadstereo::io
#pragma GCC visibility pop

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Roll, pitch and height of the frames of a recording, smoothed over time (`smooth_series`).
class PoseTable {
 public:
  void add(const FlightFrame& frame);

  /// Returns pose.csv: one row per frame, with standard errors. Unknown values are empty. If the time of any frame is
  /// unknown, frame numbers are used instead of times.
  std::string csv() const;

 private:
  struct Pose {
    std::int64_t frame = 0;
    double time_s = 0;
    Measurement roll_rad;             ///< NaN where the roll is not observable
    Measurement pitch_rad, height_m;  ///< NaN unknown
  };
  std::vector<Pose> poses_;
};

}  // namespace roadstereo::io
#pragma GCC visibility pop

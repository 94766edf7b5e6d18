#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "processing_options.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// What can be written of every frame.
enum class FrameFile { disparity, transformed, sheet, cloud, overlay };

/// The file of that name. Throws Error naming those that exist.
FrameFile frame_file(const std::string& name);

/// The track that places a flight on the earth.
struct TrackSettings {
  std::string file;          ///< empty: no track
  double offset_s = 0;       ///< added to the frames' times to have the track's
  double mount_yaw_deg = 0;  ///< the camera's forward against the heading, clockwise
};

/// What the command line says about a flight.
struct FlightSettings {
  std::vector<std::string> source;  ///< one name, or left and right
  std::vector<std::string> calibration;
  std::string output;
  ProcessingSettings processing;
  SourceChoice choice;
  bool resume = false;
  std::int64_t from = 0;           ///< first frame of the source, from 0
  std::optional<std::int64_t> to;  ///< last frame, included; absent: the end
  std::int64_t every = 1;          ///< takes each so-manieth frame
  std::vector<std::string> write;  ///< names of FrameFile
  TrackSettings track;
  bool quiet = false;
  bool json = false;

  /// Throws Error naming what is out of range.
  void validate() const;
};

}  // namespace roadstereo::cli

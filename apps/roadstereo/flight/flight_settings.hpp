#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "processing_options.hpp"
#include "report_head.hpp"
#include "source_options.hpp"

namespace roadstereo::cli {

/// Optional output files of a frame.
enum class FrameFile { disparity, transformed, sheet, cloud, overlay };

/// Parses the name of a FrameFile. Throws Error listing the names.
FrameFile frame_file(const std::string& name);

/// Options of the GNSS track.
struct TrackSettings {
  std::string file;          ///< empty: no track
  double offset_s = 0;       ///< added to the times of the frames
  double offset_sd_s = 10;   ///< expected error of `offset_s`, for the trajectory
  double mount_yaw_deg = 0;  ///< yaw of the camera relative to the heading, clockwise
};

/// Command line options of `inspect`.
struct FlightSettings {
  std::vector<std::string> source;  ///< one name, or left and right
  std::vector<std::string> calibration;
  std::string disparity;  ///< map of one pair that replaces matching; empty: none
  std::string mask;       ///< picture whose white pixels are left out; empty: none
  bool auto_mask = true;  ///< leaves out what never moves, unless there is a mask
  std::string output;
  ProcessingSettings processing;
  SourceSettings source_settings;
  bool resume = false;
  std::int64_t from = 0;           ///< first frame of the source, from 0
  std::optional<std::int64_t> to;  ///< last frame, inclusive; absent: the end
  std::int64_t every = 1;          ///< processes every N-th frame
  std::vector<std::string> write;  ///< names of FrameFile, and "mcap"
  TrackSettings track;
  bool trajectory = false;  ///< estimates the motion from frame to frame
  bool map = false;         ///< makes a map along the trajectory
  bool candidates = false;  ///< whether the GIS files have a layer of candidates
  ReportHead head;
  std::optional<double> height_m;   ///< of the camera above the road, expected
  std::optional<double> pitch_deg;  ///< of the camera, expected
  bool quiet = false;
  bool json = false;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Options of the pipeline, those of --height, --pitch and --mask included. Throws Error naming the option that is
/// unknown or out of range.
PipelineOptions make_options(const FlightSettings& settings);

/// Reads --mask: 255 where the picture has 255; empty without --mask. Throws Error if the picture has values above 0,
/// and none of 255.
Image<std::uint8_t> read_ignored(const FlightSettings& settings);

/// Throws Error unless the mask is empty or has the size of the frames.
void require_mask_size(const FlightSettings& settings, const Image<std::uint8_t>& mask, int width, int height);

/// Files that must not be overwritten or removed.
std::vector<std::string> input_files(const FlightSettings& settings);

/// Parsed and checked options of a flight.
struct FlightPlan {
  PipelineOptions options;
  Image<std::uint8_t> mask;      ///< not 0 left out; empty: none
  bool auto_mask = true;         ///< leaves out what never moves
  bool find_white_level = true;  ///< determines it from the pairs of a 16-bit source
  io::SourceOptions source;
  std::vector<FrameFile> write;
  bool mcap = false;  ///< writes flight.mcap
};

/// Parses and checks the command line options. Throws Error naming the option that is unknown or out of range.
FlightPlan resolve(const FlightSettings& settings);

}  // namespace roadstereo::cli

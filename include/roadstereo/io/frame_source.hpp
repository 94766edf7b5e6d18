#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"
#include "roadstereo/io/calibration_file.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Arrangement of both views in one image.
enum class StereoLayout {
  automatic,     ///< the layout whose views have an aspect ratio of 5:4 … 2.4:1; Error if there is none
  side_by_side,  ///< left view in the left half
  top_bottom     ///< left view in the upper half
};

/// Parses "auto", "side-by-side" or "top-bottom". Throws Error listing them for another name.
StereoLayout stereo_layout(const std::string& name);

struct SourceOptions {
  StereoLayout layout = StereoLayout::automatic;  ///< of videos and cameras
  std::vector<std::string> topics;                ///< left and right image topic of a ROS bag, two names; empty: the
                                                  ///< only pair
  double max_time_difference_s = 0.005;           ///< between the views of a pair, 0 … 10
  int camera_width = 2560;  ///< of the image with both views, requested from a V4L2 camera; 64 … 16384
  int camera_height = 720;  ///< likewise
  double rate_hz = 0;       ///< pairs per second, replaces the times of a recording; 0 … 10000; 0: off

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// One unrectified pair of a source, or the reason why it is missing.
struct SourcePair {
  std::int64_t index = 0;  ///< in the source, from 0
  std::string name;        ///< file name, or the index in six digits
  double time_s =
      std::numeric_limits<double>::quiet_NaN();  ///< since 1970 if known, else since the start of the source
  Frame left;
  Frame right;
  double white_level = 0;  ///< sample value of white of 16-bit images, where somebody has determined it; 0: unknown
  std::string error;       ///< reason if the pair is invalid: unreadable, unpaired, too far apart in time; empty: valid
};

/// A recording or a camera. Not thread-safe.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Returns the next pair, or nullopt at the end. An invalid pair is returned with `error` set. Throws Error if the
  /// source itself fails, e.g. a camera is unplugged.
  virtual std::optional<SourcePair> next() = 0;

  /// Skips pairs, without decoding them if the format allows it. Stops at the end.
  virtual void skip(std::int64_t pairs) = 0;

  /// Number of pairs if known, else nullopt. An estimate for videos, which may be off by a few, and for bags: each
  /// image without a partner is a pair of its own, and `next` returns more.
  virtual std::optional<std::int64_t> size() const = 0;

  /// Whether the source is a camera: pairs arrive in real time and never end.
  virtual bool live() const { return false; }

  /// Calibration contained in the source, if any: camera_info of a bag, calibration.yaml in a folder or beside a list.
  virtual std::optional<CalibrationFile> calibration() const { return std::nullopt; }

  /// File that `calibration` reads; empty if it is part of the source, or if there is none.
  virtual std::string calibration_file() const { return {}; }

  /// Short description for messages, e.g. "folder, 300 pairs".
  virtual std::string description() const = 0;
};

/// Opens a recording or a camera. Recognises:
///   folder         with left/ right/, image_2/ image_3/, image_0/ image_1/, image_02/data image_03/data,
///                  cam0/data cam1/data (EuRoC), or L*.png R*.png names; times from times.txt,
///                  timestamps.txt (KITTI raw data), or names that are times (EuRoC)
///   list file      .txt or .csv: lines "left right [seconds]", paths relative to the list; # starts a comment
///   video          both views in one image, see StereoLayout
///   two names      left and right: two folders or two videos
///   /dev/video*    V4L2 camera with both views in one image
///   GStreamer      a pipeline description, i.e. text with " ! "; if it has no appsink,
///                  " ! videoconvert ! appsink max-buffers=2 sync=false" is appended (live pipelines then drop frames)
///   .bag           ROS 1 bag with two image topics
///   .mcap, .db3    bag of ROS 2 with two image topics (MCAP also of ROS 1), or the folder of rosbag2 around it;
///                  unindexed and cut off MCAP files are read up to their end
/// Throws Error if the source is none of these or cannot be opened.
std::unique_ptr<FrameSource> open_source(const std::vector<std::string>& names, const SourceOptions& options = {});

/// Returns whether `open_source` accepts the name; false for an image and for a missing file.
bool is_recording(const std::string& name);

}  // namespace roadstereo::io
#pragma GCC visibility pop

#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"
#include "roadstereo/io/calibration_file.hpp"

namespace roadstereo::io {

/// How one picture holds both views.
enum class StereoLayout {
  automatic,     ///< the one whose views have the shape of a camera's, 5:4 … 2.4:1; Error where none has
  side_by_side,  ///< left view in the left half
  top_bottom     ///< left view in the upper half
};

/// The layout of that name: "auto", "side-by-side" or "top-bottom". Throws Error naming those that exist.
StereoLayout stereo_layout(const std::string& name);

struct SourceOptions {
  StereoLayout layout = StereoLayout::automatic;  ///< of videos and cameras
  std::vector<std::string> topics;                ///< left and right image topic of a ROS bag; empty: the only two
  double max_time_difference_s = 0.005;           ///< between the views of a pair; more is refused, 0 … 10
  int camera_width = 2560;  ///< of the whole picture, asked of a V4L2 camera, which takes its nearest; 64 … 16384
  int camera_height = 720;  ///< likewise
  double rate_hz = 0;  ///< pairs a second where the source has no times, 0 … 10000; 0: the source's own, or no times

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// One pair as the source has it, not rectified yet; or the reason why there is none.
struct SourcePair {
  std::int64_t index = 0;  ///< its place in the source, from 0
  std::string name;        ///< of the file, or the place in six digits
  double time_s =
      std::numeric_limits<double>::quiet_NaN();  ///< since 1970 where the source knows, else since its start
  Frame left;
  Frame right;
  std::string refused;  ///< why the views are no pair: unreadable, no partner, too far apart in time; empty: they are
};

/// A recording or a camera. Not for two threads at a time.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// The next pair; nothing at the end. A pair that cannot be had is returned with its reason. Throws Error when the
  /// source itself fails: a camera that is gone.
  virtual std::optional<SourcePair> next() = 0;

  /// Passes over pairs without decoding them, where the format allows it. Stops at the end.
  virtual void skip(std::int64_t pairs) = 0;

  /// Pairs from first to last, where the source knows. A video's own figure may be off by a few.
  virtual std::optional<std::int64_t> size() const = 0;

  /// A camera: pairs come when they are taken, and never end.
  virtual bool live() const { return false; }

  /// Calibration that travels with the pairs (camera_info of a bag), where there is one.
  virtual std::optional<CalibrationFile> calibration() const { return std::nullopt; }

  /// What it is, for people: "folder, 300 pairs".
  virtual std::string description() const = 0;
};

/// Opens a recording or a camera; the kind is recognised:
///   folder         with left/ right/, image_2/ image_3/, image_0/ image_1/, image_02/data image_03/data,
///                  cam0/data cam1/data (EuRoC), or L*.png R*.png names; times from times.txt, data.csv or EuRoC names
///   list file      .txt or .csv: "left right [seconds]" a line, relative to the list; # begins a comment
///   video          both views in one picture, see StereoLayout
///   two names      left and right: two folders or two videos
///   /dev/video*    V4L2 camera with both views in one picture
///   GStreamer      a pipeline: a text with " ! "; " ! videoconvert ! appsink max-buffers=2 sync=false" is added when
///                  it has no appsink, and drops pictures that come too fast when the pipeline is live
///   .bag           ROS 1 bag with two image topics
/// Throws Error when it is none of these or cannot be opened.
std::unique_ptr<FrameSource> open_source(const std::vector<std::string>& names, const SourceOptions& options = {});

/// Whether `open_source` would take that name; an image, or what does not exist, is none.
bool is_recording(const std::string& name);

}  // namespace roadstereo::io

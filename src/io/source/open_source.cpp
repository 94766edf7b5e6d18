#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/require_range.hpp"
#include "io/plain_text.hpp"
#include "io/source/message_log.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

enum class Kind { folder, list, video, camera, gstreamer, bag };

template <std::size_t N>
bool is_one_of(const std::string& word, const std::array<const char*, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array bag_extensions = {".bag", ".db3", ".mcap"};
constexpr std::array list_extensions = {".txt", ".csv", ".lst"};
constexpr std::array video_extensions = {".mp4",   ".avi", ".mkv",  ".mov",  ".m4v",  ".webm", ".ts",  ".mjpg",
                                         ".mjpeg", ".mpg", ".mpeg", ".h264", ".h265", ".hevc", ".y4m", ".wmv"};

std::optional<Kind> known_kind(const std::string& name) {
  if (name.find(" ! ") != std::string::npos) return Kind::gstreamer;
  std::error_code ignored;
  if (fs::is_character_file(name, ignored) || name.starts_with("/dev/video")) return Kind::camera;
  if (fs::is_directory(name, ignored)) return is_message_log(name) ? Kind::bag : Kind::folder;
  if (!fs::exists(name, ignored)) return std::nullopt;
  const std::string extension = lower_case(fs::path(name).extension().string());
  if (is_one_of(extension, bag_extensions)) return Kind::bag;
  if (is_one_of(extension, list_extensions)) return Kind::list;
  if (is_one_of(extension, video_extensions)) return Kind::video;
  return std::nullopt;
}

Kind kind_of(const std::string& name) {
  if (const auto kind = known_kind(name)) return *kind;
  const std::string extension = lower_case(fs::path(name).extension().string());
  std::error_code ignored;
  if (!fs::exists(name, ignored)) {
    fail(name, ": no such file, folder, camera (/dev/video0) or GStreamer pipeline (a ! b)");
  }
  if (extension == ".svo" || extension == ".svo2") {
    fail(name, ": SVO files of ZED cameras need the ZED SDK; export them as side-by-side video first");
  }
  fail(name,
       ": unknown source type; supported are a folder, a list (.txt, .csv), a video (.mp4, .avi, .mkv, …), a ROS ",
       "bag (.bag, .db3, .mcap, or a folder of rosbag2), a camera (/dev/video0) and a GStreamer pipeline; for a single "
       "pair give two images, left and right");
}

std::unique_ptr<FrameSource> open_one(const std::string& name, const SourceOptions& options) {
  switch (kind_of(name)) {
    case Kind::folder:
      return open_folder(name, options);
    case Kind::list:
      return open_list(name, options);
    case Kind::video:
      return open_video(name, options);
    case Kind::camera:
      return open_camera(name, options);
    case Kind::gstreamer:
      return open_gstreamer(name, options);
    case Kind::bag:
      return open_bag(name, options);
  }
  fail(name, ": unknown source type");
}

std::unique_ptr<FrameSource> open_two(const std::string& left, const std::string& right, const SourceOptions& options) {
  const Kind kind = kind_of(left);
  if (kind == kind_of(right)) {
    if (kind == Kind::folder) return open_two_folders(left, right, options);
    if (kind == Kind::video) return open_two_videos(left, right, options);
  }
  fail(left, " and ", right, ": two sources must be two folders or two videos, left and right");
}

}  // namespace

StereoLayout stereo_layout(const std::string& name) {
  if (name == "auto") return StereoLayout::automatic;
  if (name == "side-by-side") return StereoLayout::side_by_side;
  if (name == "top-bottom") return StereoLayout::top_bottom;
  fail("the layout is \"", name, "\"; it must be auto, side-by-side or top-bottom");
}

void SourceOptions::validate() const {
  require_range("source", "max_time_difference_s", max_time_difference_s, 0.0, 10.0);
  require_range("source", "rate_hz", rate_hz, 0.0, 10000.0);
  require_range("source", "camera_width", camera_width, 64, 16384);
  require_range("source", "camera_height", camera_height, 64, 16384);
  if (!topics.empty() && topics.size() != 2) {
    fail("source.topics has ", topics.size(), " names; it must have two: left and right image topic");
  }
}

bool is_recording(const std::string& name) {
  return known_kind(name).has_value();
}

std::unique_ptr<FrameSource> open_source(const std::vector<std::string>& names, const SourceOptions& options) {
  options.validate();
  if (names.size() == 1) return open_one(names[0], options);
  if (names.size() == 2) return open_two(names[0], names[1], options);
  fail("a source has one name, or two: left and right; got ", names.size());
}

}  // namespace roadstereo::io

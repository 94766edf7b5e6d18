#pragma once

#include <memory>
#include <string>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

// One opener per kind of source; `open_source` chooses. Each throws Error naming what cannot be opened.

std::unique_ptr<FrameSource> open_folder(const std::string& folder, const SourceOptions& options);
std::unique_ptr<FrameSource> open_two_folders(const std::string& left, const std::string& right,
                                              const SourceOptions& options);
std::unique_ptr<FrameSource> open_list(const std::string& file, const SourceOptions& options);

/// Both views in one picture. Times are those of a constant rate, `rate_hz` or the video's own.
std::unique_ptr<FrameSource> open_video(const std::string& file, const SourceOptions& options);
/// Paired by number; what one has more than the other is refused.
std::unique_ptr<FrameSource> open_two_videos(const std::string& left, const std::string& right,
                                             const SourceOptions& options);

/// V4L2, both views in one picture; `next` throws Error when the camera is gone.
std::unique_ptr<FrameSource> open_camera(const std::string& device, const SourceOptions& options);
/// Both views in one picture. Adds " ! videoconvert ! appsink max-buffers=2 sync=false" to a pipeline without appsink.
/// Live is what GStreamer calls live. Where the pipeline ends, `next` returns nothing; where it fails, it throws Error.
std::unique_ptr<FrameSource> open_gstreamer(const std::string& pipeline, const SourceOptions& options);

/// ROS 1. Throws Error, too, when the program was built without it.
std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions& options);

}  // namespace roadstereo::io

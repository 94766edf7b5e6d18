#pragma once

#include <memory>
#include <string>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

// One opener per kind of source, see `open_source`. Each throws Error naming what cannot be opened.

std::unique_ptr<FrameSource> open_folder(const std::string& folder, const SourceOptions& options);
std::unique_ptr<FrameSource> open_two_folders(const std::string& left, const std::string& right,
                                              const SourceOptions& options);
std::unique_ptr<FrameSource> open_list(const std::string& file, const SourceOptions& options);

/// Both views in one image. Times follow from a constant rate: `rate_hz`, or that of the video.
std::unique_ptr<FrameSource> open_video(const std::string& file, const SourceOptions& options);
/// Paired by frame number; surplus frames of the longer video are invalid pairs.
std::unique_ptr<FrameSource> open_two_videos(const std::string& left, const std::string& right,
                                             const SourceOptions& options);

/// V4L2, both views in one image; `next` throws Error if the camera is unplugged.
std::unique_ptr<FrameSource> open_camera(const std::string& device, const SourceOptions& options);
/// Both views in one image. Appends " ! videoconvert ! appsink max-buffers=2 sync=false" to a pipeline without appsink.
/// `next` returns nullopt at the end of the pipeline and throws Error if it fails. A live one keeps its own times.
std::unique_ptr<FrameSource> open_gstreamer(const std::string& pipeline, const SourceOptions& options);

/// ROS 1, rosbag2, MCAP. Also throws Error if built without it.
std::unique_ptr<FrameSource> open_bag(const std::string& file, const SourceOptions& options);

}  // namespace roadstereo::io

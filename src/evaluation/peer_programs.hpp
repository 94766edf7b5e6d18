#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Frames as files, for programs of others: left images (PNG) and depths (16-bit PNG).
class PeerFrames {
 public:
  /// Creates the folder.
  PeerFrames(std::filesystem::path folder, const StereoCalibration& calibration);

  void add(const GreyImage& grey, const Image<float>& disparity);

  const std::filesystem::path& folder() const { return folder_; }
  const StereoCalibration& calibration() const { return calibration_; }
  int frames() const { return frames_; }
  /// Depth of the largest value, metres.
  double max_depth_m() const;

 private:
  std::filesystem::path folder_;
  StereoCalibration calibration_;
  int frames_ = 0;
};

/// What a program made of them.
struct PeerPoses {
  std::vector<std::optional<std::array<double, 12>>> camera_to_world;  ///< 3×4, a frame
  double seconds = 0;                                                  ///< of all frames
};

/// COLMAP: structure from motion of the left images with their focal length known, on the CPU. Its scale is unknown.
/// Throws Error where `colmap` is not in PATH, or fails.
PeerPoses run_colmap(const PeerFrames& frames);

/// Open3D's RGB-D odometry (hybrid term) from frame to frame, from the last motion on. Throws Error where python3 has
/// no open3d, or fails.
PeerPoses run_open3d(const PeerFrames& frames);

}  // namespace roadstereo::io

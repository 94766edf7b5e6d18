#pragma once

#include <array>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Pose of the rectified left camera (x right, y down, z forward) at one frame.
struct FramePose {
  int frame = 0;  ///< index of the pair in its source, from 0
  int piece = 0;  ///< piece of the trajectory, from 0; frames of different pieces are not linked
  std::array<double, 12> camera_to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< 3×4, row-major, metres
  /// Covariance of the pose against the first frame of its piece, row-major 6×6: translation (metres), then rotation
  /// vector (radians), both in the axes of this camera.
  std::array<double, 36> covariance{};
};

/// Poses of a recording, in order of its frames. World: without positions, the camera of the first frame of each piece;
/// with a track, x east, y north, z up of a projected coordinate system, metres.
struct Trajectory {
  std::vector<FramePose> frames;
};

}  // namespace roadstereo
#pragma GCC visibility pop

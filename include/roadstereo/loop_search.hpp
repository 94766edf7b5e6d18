#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "roadstereo/odometry.hpp"
#include "roadstereo/pose_graph.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Finds places that a recording passes again, in any direction. Frames far apart in time whose views of the road may
/// overlap, given the covariance of their poses, are linked in the way `Odometry` links neighbouring frames. Keyframes
/// are kept on disk, at most 1.5 MB each, so that memory does not grow with the recording.
class LoopSearch {
 public:
  /// `folder` is used for the keyframes alone, and is removed by the destructor. Throws Error if it contains anything
  /// but keyframes of an earlier search, SystemError if it cannot be written.
  LoopSearch(const StereoCalibration& calibration, std::filesystem::path folder, const OdometryOptions& options = {});
  ~LoopSearch();
  LoopSearch(LoopSearch&&) noexcept;
  LoopSearch& operator=(LoopSearch&&) noexcept;

  /// Adds a frame, whose index must be larger than that of the last one; it is enough to add the frames that `Odometry`
  /// makes its reference. Frames without a road are ignored. `offset_px`: FrameLink::offset_px of that frame. Throws
  /// Error if the index or the size of the maps is wrong, or the calibration is of another size; SystemError on a full
  /// disk.
  void add(int frame, const OdometryFrame& maps, double offset_px = 0);
  void add(int frame, const FrameResult& result, double offset_px = 0);

  /// Number of pairs of frames that were compared.
  std::size_t compared() const;

  /// Returns the loops among the frames that earlier calls have not returned. `odometry` is the trajectory of
  /// `Odometry`, `best` the best estimate of it so far. Throws Error naming an added frame that one of them lacks.
  std::vector<LoopLink> find(const Trajectory& odometry, const Trajectory& best);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Alternates between optimising the poses of a recording and searching for loops, since new loops improve the poses
/// and better poses reveal more loops, until no more are found; at most three times. Throws as `optimise_poses` and
/// `LoopSearch` do.
PoseGraphResult close_loops(PoseGraphInput input, LoopSearch& search, const PoseGraphOptions& options = {});

}  // namespace roadstereo
#pragma GCC visibility pop

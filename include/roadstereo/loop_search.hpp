#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "roadstereo/odometry.hpp"
#include "roadstereo/pose_graph.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Finds places that a recording shows again, in whatever direction: frames far apart in time whose views of the road
/// overlap, as far as the covariance of their poses tells, are linked as `Odometry` links neighbours. Keyframes are
/// kept on disk, at most 1.5 MB each, so that memory does not grow with the recording.
class LoopSearch {
 public:
  /// `folder` becomes one of its own, and is removed at the end. Throws Error if it holds anything but keyframes of an
  /// earlier search, SystemError if it cannot be written.
  LoopSearch(const StereoCalibration& calibration, std::filesystem::path folder, const OdometryOptions& options = {});
  ~LoopSearch();
  LoopSearch(LoopSearch&&) noexcept;
  LoopSearch& operator=(LoopSearch&&) noexcept;

  /// Keeps a frame, with an index above that of the last one; those that `Odometry` makes its reference suffice. Frames
  /// without a road are left out. `offset_px`: of the link of that frame. Throws Error if the index or the size of the
  /// maps is wrong, or the calibration is of another size; SystemError on a full disk.
  void add(int frame, const OdometryFrame& maps, double offset_px = 0);
  void add(int frame, const FrameResult& result, double offset_px = 0);

  /// Number of pairs of frames that were compared.
  std::size_t compared() const;

  /// Returns loops among the frames, without those of earlier calls. `odometry` is the trajectory of all frames as
  /// `Odometry` has it, `best` what is best known of it. Throws Error naming an added frame that one of them lacks.
  std::vector<LoopLink> find(const Trajectory& odometry, const Trajectory& best);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Optimises the poses of a recording and searches loops, which tell where more may be, in turns until there are no
/// more; three times at most. Throws as `optimise_poses` and `LoopSearch` do.
PoseGraphResult close_loops(PoseGraphInput input, LoopSearch& search, const PoseGraphOptions& options = {});

}  // namespace roadstereo
#pragma GCC visibility pop

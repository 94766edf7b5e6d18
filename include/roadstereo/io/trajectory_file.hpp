#pragma once

#include <string>
#include <vector>

#include "roadstereo/trajectory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Reads a trajectory as KITTI has it: one line of 12 numbers per frame, the 3×4 matrix from the camera of the frame to
/// the world, metres; line i (from 0) is frame i. `nan` marks a frame without a pose. Throws Error naming the file, the
/// line, and a matrix that is no rotation.
Trajectory read_trajectory(const std::string& path);

/// Writes what `read_trajectory` reads: the poses of one piece; the lines of other frames are `nan`.
std::string kitti_trajectory(const Trajectory& trajectory, int piece);

/// Writes the poses of one piece as the TUM RGB-D benchmark has them: one line "time x y z qx qy qz qw" per frame,
/// camera to world. `times_s` has one entry per frame of the trajectory, of all pieces; where it is NaN the index of
/// the frame stands for it.
std::string tum_trajectory(const Trajectory& trajectory, int piece, const std::vector<double>& times_s);

/// Returns the piece with the most frames, the first of them; 0 for an empty trajectory.
int longest_piece(const Trajectory& trajectory);

}  // namespace roadstereo::io
#pragma GCC visibility pop

#pragma once

#include <string>
#include <vector>

#include "roadstereo/trajectory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Reads a trajectory as KITTI has it: one line of 12 numbers per frame, the 3×4 matrix from the camera of the frame to
/// the world, metres; line i (from 0) is frame i. `nan` marks a frame without a pose. All poses are of piece 0. Throws
/// Error naming the file and the line for a word that is no number, a line without 12 numbers and a matrix that is no
/// rotation, a reflection in particular; Error for a file without a pose, SystemError if it cannot be read to its end.
Trajectory read_trajectory(const std::string& path);

/// Writes what `read_trajectory` reads: the poses of one piece; the lines of other frames are `nan`.
std::string kitti_trajectory(const Trajectory& trajectory, int piece);

/// Writes the poses of one piece in the format of the TUM RGB-D benchmark: after a comment line, one line "time x y z
/// qx qy qz qw" per frame, camera to world. `times_s` has one entry, in seconds, for every frame of the trajectory, of
/// all pieces. If an entry of this piece is NaN or missing, the times of all its frames are their indices.
std::string tum_trajectory(const Trajectory& trajectory, int piece, const std::vector<double>& times_s);

/// Returns the piece with the most frames, the first one if several have as many; 0 for an empty trajectory.
int longest_piece(const Trajectory& trajectory);

}  // namespace roadstereo::io
#pragma GCC visibility pop

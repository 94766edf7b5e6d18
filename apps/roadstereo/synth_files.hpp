#pragma once

#include <array>
#include <string>
#include <vector>

#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Number of a frame and the number of frames.
struct FrameNumber {
  int frame = 0;
  int frames = 1;

  /// Returns "left.png" for a single pair, "left/000007.png" for frame 7 of several.
  std::string path(const std::string& name, const std::string& extension) const;
};

/// Names of the files of one pair, that of the truth last.
std::vector<std::string> synthetic_pair_files(const FrameNumber& number);

/// Stages the images and the ground truth of one pair.
void add_synthetic_pair(const synth::Scene& scene, const synth::SyntheticPair& pair, const FrameNumber& number,
                        io::OutputFolder& folder);

/// Returns the true trajectory as KITTI has it: a 3×4 pose per line, from the camera of the frame to that of the first.
std::string true_trajectory(const std::vector<std::array<double, 12>>& camera_to_road);

/// Returns the times of the frames in seconds, one per line, starting at 0.
std::string frame_times(int frames, double rate_hz);

}  // namespace roadstereo::cli

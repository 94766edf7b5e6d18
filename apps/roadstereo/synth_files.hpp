#pragma once

#include <string>

#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Which frame of how many a pair is.
struct FrameNumber {
  int frame = 0;
  int frames = 1;

  /// "left.png" for a single pair, "left/000007.png" for frame 7 of several.
  std::string path(const std::string& name, const std::string& extension) const;
};

/// Stages the images and the truth of one pair.
void add_synthetic_pair(const synth::Scene& scene, const synth::SyntheticPair& pair, const FrameNumber& number,
                        io::OutputFolder& folder);

/// A calibration as plain YAML.
std::string plain_yaml(const StereoCalibration& calibration);

/// The time of every frame in seconds, a line each; the first is at 0.
std::string frame_times(int frames, double rate_hz);

}  // namespace roadstereo::cli

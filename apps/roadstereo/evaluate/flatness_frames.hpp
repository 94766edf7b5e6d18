#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// σ_d of one road, pixels (eq. sigma_d).
struct Flatness {
  double without_roll_px = 0;            ///< ψ = 0, only α0 and α1 are fitted
  std::array<double, 3> with_roll_px{};  ///< ψ by each of roll_solvers()
  std::array<double, 3> roll_rad{};      ///< what they found
};

/// One frame of a folder laid out like KITTI Stereo 2015.
struct FlatnessFrame {
  std::string name;
  Flatness truth;    ///< of the ground truth inside the road mask
  Flatness matched;  ///< of the pipeline's own disparities inside the same mask
};

/// The folders of the frames: disparities `disp_noc_0`, images `image_2` and `image_3`, files of one name in each.
struct FlatnessFolders {
  std::filesystem::path data;
  std::filesystem::path road_masks;
};

/// Names of the frames that have ground truth, in order. Throws Error when there are none.
std::vector<std::string> flatness_frames(const FlatnessFolders& folders);

Flatness measure_flatness(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, int threads);

/// Reads the frame, matches it with `options` and measures both. Throws Error naming the file that is wrong.
FlatnessFrame measure_frame(const FlatnessFolders& folders, const std::string& name, const PipelineOptions& options);

}  // namespace roadstereo::cli

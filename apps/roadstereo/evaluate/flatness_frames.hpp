#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "evaluate/kitti_frames.hpp"
#include "evaluate/methods.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// σ_d of one road, pixels (eq. sigma_d).
struct Flatness {
  double without_roll_px = 0;            ///< ψ = 0, only α0 and α1 are fitted
  std::array<double, 3> with_roll_px{};  ///< ψ by each of roll_solvers()
  std::array<double, 3> roll_rad{};      ///< what they found
};

/// One frame of KITTI Stereo 2015.
struct FlatnessFrame {
  std::string name;
  Flatness truth;    ///< of the ground truth inside the road mask
  Flatness matched;  ///< of the preset's own disparities inside the same mask
};

Flatness measure_flatness(ImageView<const float> disparity, ImageView<const std::uint8_t> mask, int threads);

/// Reads the frame, matches it with the preset and measures both. Throws Error when the frame has no road mask, or one
/// of another size.
FlatnessFrame measure_frame(const KittiFiles& files, const std::string& preset, const MethodSettings& methods);

}  // namespace roadstereo::cli

#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "evaluate/kitti_frames.hpp"
#include "evaluate/methods.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// σ_d of one road, pixels (eq. (37), sigma_d).
struct Flatness {
  double without_roll_px = 0;            ///< with ψ = 0; only α0 and α1 are fitted
  std::array<double, 3> with_roll_px{};  ///< with ψ by each of roll_solvers()
};

/// One frame of KITTI Stereo 2015.
struct FlatnessFrame {
  std::string name;
  Flatness truth;    ///< of the ground truth inside the road mask
  Flatness matched;  ///< of the disparities of the preset inside the same mask
};

/// Read a frame, match it with the preset, and measure ground truth and match. Throws Error when the frame has no road
/// mask.
FlatnessFrame measure_frame(const KittiFiles& files, const std::string& preset, const MethodSettings& methods);

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "evaluation/sub_pixel_bias.hpp"
#include "evaluation/sub_pixel_noise.hpp"

namespace roadstereo::cli {

/// Figures of one method under one noise.
struct SubPixelTrial {
  std::string method;
  double noise_grey = 0;  ///< standard deviation of each image, grey levels
  SubPixelBias bias{};    ///< by the phase of the disparity that the method fits
  SubPixelNoise noise{};
  double valid_share = 0;
};

/// Match two shots of each of `roads` wave roads with every method and under every noise. The phase of a preset is that
/// of the true disparity in the transformed pair, that of OpenCV's matchers in the pair itself.
std::vector<SubPixelTrial> measure_subpixel(int roads, const std::vector<double>& noises_grey,
                                            const MethodSettings& settings);

}  // namespace roadstereo::cli

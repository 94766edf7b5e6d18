#pragma once

#include <cstdint>
#include <optional>

#include "pair_source.hpp"

namespace roadstereo::cli {

/// Stereo pair with ground truth.
struct LabelledFrame {
  StereoPair pair;
  Image<float> truth;                       ///< pixels; NaN where it is unknown
  std::optional<Image<std::uint8_t>> road;  ///< not 0 on the road
  int disparities = 0;                      ///< that OpenCV's matchers search
};

/// Number of disparities that includes the maximum of the truth, at least `usual`.
int disparities_of(ImageView<const float> truth, int usual);

}  // namespace roadstereo::cli

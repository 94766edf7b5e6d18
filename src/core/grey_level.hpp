#pragma once

#include <cstdint>

#include "roadstereo/uncontracted.hpp"

namespace roadstereo {

/// Weights of the samples of a pixel in its grey level, and the level of white.
struct GreyWeights {
  float first, second, third;
  float white;
};

/// Rounds a level and clips it at white.
ROADSTEREO_HD inline std::int16_t rounded_level(float level, float white) {
  const float rounded = level + 0.5F;
  return static_cast<std::int16_t>(rounded < white ? rounded : white);
}

/// Grey level of a pixel with one sample.
ROADSTEREO_HD inline std::int16_t grey_level(const GreyWeights& weights, float sample) {
  return rounded_level(uncontracted_product(weights.first, sample), weights.white);
}

/// Grey level of a pixel of three colours.
ROADSTEREO_HD inline std::int16_t grey_level(const GreyWeights& weights, float first, float second, float third) {
  return rounded_level(uncontracted_product(weights.first, first) + uncontracted_product(weights.second, second) +
                           uncontracted_product(weights.third, third),
                       weights.white);
}

}  // namespace roadstereo

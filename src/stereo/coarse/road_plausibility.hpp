#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

// Whether the costs of a pixel allow the road that the model predicts. C++17, for kernels.

/// Cost of a disparity without a counterpart: that of uncorrelated blocks.
constexpr float uncorrelated_cost = 1;
/// Texture uncertainty below which the plausibility of the road is not computed: all that the road can cost is small.
constexpr float min_uncertainty = 0.1F;

/// Disparities within two coarse pixels of the road's, of `count`: first ≤ d < end.
struct NearRoad {
  int first, end;
};

ROADSTEREO_HD inline NearRoad near_road(float road, int count) {
  constexpr int near = 2;
  const int centre = static_cast<int>(road + 0.5F);  // NOLINT(bugprone-incorrect-roundings): not negative
  const int first = centre - near < 0 ? 0 : centre - near > count ? count : centre - near;
  const int wanted = centre + near + 1;
  return {first, wanted < first ? first : wanted > count ? count : wanted};
}

/// Plausibility of the road, 0 … 1: 1 where the costs near it are as small as the smallest of the pixel, 0 where those
/// elsewhere are smaller by 0.4.
ROADSTEREO_HD inline float cost_plausibility(float at_road, float smallest) {
  constexpr float plausible_below = 0.2F, rejected_above = 0.4F;  // in units of the correlation
  const float plausibility = (rejected_above - (at_road - smallest)) / (rejected_above - plausible_below);
  return plausibility < 0.0F ? 0.0F : plausibility > 1.0F ? 1.0F : plausibility;
}

}  // namespace roadstereo

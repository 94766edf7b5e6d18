#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "core/straightedge.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo {

double straightedge_gap(std::span<const double> heights_m, double spacing_m, double straightedge_m) {
  const std::vector<double> gaps = straightedge_gaps(heights_m, spacing_m, straightedge_m);
  return gaps.empty() ? 0 : *std::max_element(gaps.begin(), gaps.end());
}

double straightedge_noise_gap(std::size_t heights, double spacing_m, double straightedge_m) {
  constexpr int trials = 64, uniforms = 12;
  std::minstd_rand random(1);
  const auto normal = [&] {  // sum of twelve uniform numbers: the same with every standard library
    double sum = -0.5 * uniforms;
    for (int i = 0; i < uniforms; ++i)
      sum += static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max());
    return sum;
  };
  std::vector<double> profile(heights);
  double mean = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::generate(profile.begin(), profile.end(), normal);
    mean += straightedge_gap(profile, spacing_m, straightedge_m) / trials;
  }
  return mean;
}

}  // namespace roadstereo

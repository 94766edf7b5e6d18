#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadstereo/synth.hpp"

namespace roadstereo::test {

/// A named scene, quickly.
inline synth::SyntheticPair named_pair(const std::string& name) {
  synth::Scene s = synth::named_scene(name);
  s.supersampling = 1;
  return synth::render(s);
}

/// Errors against the truth where both cameras see the road.
struct Errors {
  double median = 0;
  double share_above_1px = 0;  ///< of the pixels that have a disparity
  double missing = 0;          ///< share of the pixels that have none
};

inline Errors compare(const Image<float>& disparity, const synth::SyntheticPair& truth) {
  std::vector<double> errors;
  double seen = 0, wrong = 0;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      if (truth.visible(u, v) == 0 || std::isnan(truth.disparity(u, v))) continue;
      seen += 1;
      if (std::isnan(disparity(u, v))) continue;
      errors.push_back(std::abs(disparity(u, v) - truth.disparity(u, v)));
      wrong += errors.back() > 1;
    }
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return {errors[errors.size() / 2], wrong / static_cast<double>(errors.size()),
          1 - static_cast<double>(errors.size()) / seen};
}

}  // namespace roadstereo::test

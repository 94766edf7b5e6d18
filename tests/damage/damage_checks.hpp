#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo {

/// The damage that covers most of a label; fails the test where there is none.
inline const Damage* find(const DamageMap& map, const synth::SyntheticPair& pair, int label) {
  std::vector<std::size_t> covered(map.damages.size() + 1, 0);
  for (int v = 0; v < map.ids.height(); ++v) {
    for (int u = 0; u < map.ids.width(); ++u) covered[map.ids(u, v)] += pair.labels(u, v) == label ? 1U : 0U;
  }
  const Damage* best = nullptr;
  for (const Damage& damage : map.damages) {
    const std::size_t pixels = covered[static_cast<std::size_t>(damage.id)];
    if (pixels > 0 && (best == nullptr || pixels > covered[static_cast<std::size_t>(best->id)])) best = &damage;
  }
  EXPECT_NE(best, nullptr) << "label " << label << " was not found";
  return best;
}

/// Mean column and row of the pixels of a label.
inline std::array<double, 2> label_centroid(const synth::SyntheticPair& pair, int label) {
  double u_sum = 0, v_sum = 0, n = 0;
  for (int v = 0; v < pair.labels.height(); ++v) {
    for (int u = 0; u < pair.labels.width(); ++u) {
      if (pair.labels(u, v) != label) continue;
      u_sum += u;
      v_sum += v;
      ++n;
    }
  }
  return {u_sum / n, v_sum / n};
}

inline void expect_same(const DamageMap& one, const DamageMap& other) {
  EXPECT_EQ(one.ids, other.ids);
  EXPECT_EQ(one.road, other.road);
  ASSERT_EQ(one.damages.size(), other.damages.size());
  for (std::size_t k = 0; k < one.damages.size(); ++k) {
    EXPECT_EQ(one.damages[k].max_depth_px.value, other.damages[k].max_depth_px.value);
    ASSERT_EQ(one.damages[k].metrics.has_value(), other.damages[k].metrics.has_value());
    if (!one.damages[k].metrics) continue;
    EXPECT_EQ(one.damages[k].metrics->volume_m3.value, other.damages[k].metrics->volume_m3.value);
    EXPECT_EQ(one.damages[k].metrics->area_m2.std_error, other.damages[k].metrics->area_m2.std_error);
  }
}

/// The sentence of the Error, which must name the reason.
inline void expect_error(const std::function<void()>& call, const std::string& part) {
  try {
    call();
    ADD_FAILURE() << "no error about \"" << part << "\"";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace roadstereo

#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"
#include "tests/damage/damage_scene.hpp"

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

/// Within `share` of the truth, and within `errors` standard errors where those are more than the figure's rounding.
inline void expect_figure(const char* name, const Measurement& measured, double truth, double share) {
  constexpr double errors = 3;
  EXPECT_NEAR(measured.value, truth, share * truth) << name;
  EXPECT_GT(measured.std_error, 0) << name;
  EXPECT_LT(measured.std_error, 0.5 * truth) << name;
  EXPECT_NEAR(measured.value, truth, errors * measured.std_error) << name;
}

inline void expect_truth(const DamageMap& map, const synth::SyntheticPair& pair) {
  ASSERT_TRUE(map.metric) << map.non_metric_reason;
  ASSERT_EQ(map.damages.size(), pair.damages.size());
  for (const synth::DamageTruth& known : pair.damages) {
    SCOPED_TRACE(known.kind);
    const Damage* found = find(map, pair, known.id);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->kind, known.kind == "bump" ? DamageKind::protrusion : DamageKind::depression);
    EXPECT_FALSE(found->cut_by_border);
    ASSERT_TRUE(found->metrics);
    const DamageMetrics& metrics = *found->metrics;
    expect_figure("depth", metrics.max_depth_m, known.depth_m, 0.05);
    expect_figure("area", metrics.area_m2, known.area_m2, 0.08);
    expect_figure("volume", metrics.volume_m3, known.volume_m3, 0.10);
    expect_figure("mean depth", metrics.mean_depth_m, known.mean_depth_m, 0.10);
    EXPECT_NEAR(metrics.diameter_m, 2 * std::sqrt(known.area_m2 / std::numbers::pi), 0.04 * metrics.diameter_m);
    EXPECT_NEAR(metrics.road_centroid_m[0], known.x_m, 0.01 * metrics.distance_m);
    EXPECT_NEAR(metrics.road_centroid_m[1], known.y_m, 0.01 * metrics.distance_m);
    const auto centroid = label_centroid(pair, known.id);
    EXPECT_NEAR(found->centroid_px[0], centroid[0], 1);
    EXPECT_NEAR(found->centroid_px[1], centroid[1], 1);
    EXPECT_GE(f_score(map.ids, found->id, pair.labels, known.id), 0.9);
  }
}

}  // namespace roadstereo

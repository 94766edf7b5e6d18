#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// Whether two maps have the same numbers, and are NaN in the same pixels.
inline bool equal_bits(const Image<float>& one, const Image<float>& other) {
  const auto same = [](float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); };
  return one.width() == other.width() && one.height() == other.height() &&
         std::equal(one.row(0), one.row(0) + one.pixels(), other.row(0), same);
}

/// Bits of all that is known of a damage but its words.
inline std::vector<std::uint64_t> bits_of(const Damage& damage) {
  const DamageEvidence& e = damage.evidence;
  const auto& [u0, v0, u1, v1] = damage.box_px;
  std::vector<double> figures{1.0 * damage.id,
                              1.0 * static_cast<int>(damage.kind),
                              static_cast<double>(damage.pixels),
                              damage.measured_share,
                              damage.centroid_px[0],
                              damage.centroid_px[1],
                              1.0 * u0,
                              1.0 * v0,
                              1.0 * u1,
                              1.0 * v1,
                              1.0 * damage.deepest_px[0],
                              1.0 * damage.deepest_px[1],
                              damage.max_depth_px.value,
                              damage.max_depth_px.std_error,
                              damage.mean_depth_px,
                              damage.confidence,
                              damage.cut_by_border ? 1.0 : 0.0,
                              damage.ends_search ? 1.0 : 0.0,
                              e.contrast_sigmas,
                              e.significance,
                              e.steepness,
                              e.road_share,
                              e.border_share,
                              e.unseen_share,
                              e.surface_significance,
                              e.range_vote,
                              e.specular_excess,
                              e.texture_share,
                              e.pixel_significance,
                              e.likely_wall_slope,
                              e.extent,
                              e.rut_significance,
                              e.clutter,
                              e.depth_significance};
  if (damage.metrics) {
    const DamageMetrics& m = *damage.metrics;
    for (const Measurement& one : {m.area_m2, m.max_depth_m, m.mean_depth_m, m.volume_m3}) {
      figures.insert(figures.end(), {one.value, one.std_error});
    }
    const SeverityProbabilities& p = m.severity_probabilities;
    figures.insert(figures.end(), {m.length_m, m.width_m, m.angle_rad, m.diameter_m, m.wall_slope, m.centroid_m[0],
                                   m.centroid_m[1], m.centroid_m[2], m.road_centroid_m[0], m.road_centroid_m[1],
                                   m.distance_m, m.resolvable_depth_m, m.quantity, p.minor, p.low, p.medium, p.high});
    for (const auto& [x, y] : m.outline_m) figures.insert(figures.end(), {x, y});
  }
  std::vector<std::uint64_t> bits;
  for (const double figure : figures) bits.push_back(std::bit_cast<std::uint64_t>(figure));
  return bits;
}

inline void expect_same(const std::vector<Damage>& one, const std::vector<Damage>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(one[k].max_depth_px.value, other[k].max_depth_px.value);
    EXPECT_EQ(one[k].confidence, other[k].confidence);
    ASSERT_EQ(one[k].metrics.has_value(), other[k].metrics.has_value());
    if (one[k].metrics) {
      EXPECT_EQ(one[k].metrics->volume_m3.value, other[k].metrics->volume_m3.value);
      EXPECT_EQ(one[k].metrics->distress, other[k].metrics->distress);
      EXPECT_EQ(one[k].metrics->unit, other[k].metrics->unit);
      EXPECT_EQ(one[k].metrics->severity, other[k].metrics->severity);
    }
    EXPECT_TRUE(bits_of(one[k]) == bits_of(other[k])) << "another figure differs";
  }
}

/// Bit for bit, candidates and what is unknown included.
inline void expect_same(const DamageMap& one, const DamageMap& other) {
  EXPECT_TRUE(one.ids == other.ids);
  EXPECT_TRUE(one.road == other.road);
  EXPECT_TRUE(equal_bits(one.surface, other.surface));
  EXPECT_TRUE(equal_bits(one.depth, other.depth));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(one.noise_px), std::bit_cast<std::uint64_t>(other.noise_px))
      << one.noise_px << ", " << other.noise_px;
  EXPECT_EQ(one.metric, other.metric);
  EXPECT_EQ(one.non_metric_reason, other.non_metric_reason);
  {
    SCOPED_TRACE("damages");
    expect_same(one.damages, other.damages);
  }
  SCOPED_TRACE("candidates");
  expect_same(one.candidates, other.candidates);
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

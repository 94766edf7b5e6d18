// Confidence, severity from values with errors, and maps of any scale, offset, orientation and resolution.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

SeverityTable potholes() {
  return *astm_d6433().find(Distress::pothole);
}

TEST(SeverityProbabilities, FollowNormalDistribution) {
  // 30 ± 5 mm: Φ(−1) = 0.158655 below 25 mm, Φ(−3.4) = 0.000337 below 13 mm.
  const SeverityProbabilities p = severity_probabilities(potholes(), {0.030, 0.005}, {0.3, 0});
  EXPECT_NEAR(p.minor, 0.000337, 1e-6);
  EXPECT_NEAR(p.low, 0.158655 - 0.000337, 1e-6);
  EXPECT_NEAR(p.medium, 0.841345, 1e-6);
  EXPECT_NEAR(p.high, 0, 1e-6);
  EXPECT_EQ(likely_severity(p), Severity::medium);
  // Both axes at a limit: a quarter for each of the four cells around (25 mm, 200 mm): low, low, low, medium.
  const SeverityProbabilities corner = severity_probabilities(potholes(), {0.025, 0.001}, {0.2, 0.01});
  EXPECT_NEAR(corner.low, 0.75, 1e-6);
  EXPECT_NEAR(corner.medium, 0.25, 1e-6);
  // 50 ± 1 mm and 450 ± 10 mm: medium or high below 450 mm, high above.
  const SeverityProbabilities wide = severity_probabilities(potholes(), {0.050, 0.001}, {0.45, 0.01});
  EXPECT_NEAR(wide.medium, 0.5, 1e-6);
  EXPECT_NEAR(wide.high, 0.5, 1e-6);
  EXPECT_EQ(likely_severity({0.25, 0.25, 0.25, 0.25}), Severity::uncertain);
}

TEST(SeverityProbabilities, WithoutErrorIsTable) {
  for (const double depth : {0.01, 0.02, 0.03, 0.06}) {
    for (const double diameter : {0.05, 0.15, 0.3, 0.6}) {
      const SeverityProbabilities p = severity_probabilities(potholes(), {depth, 0}, {diameter, 0});
      EXPECT_EQ(likely_severity(p), potholes().severity(depth, diameter)) << depth << " " << diameter;
      EXPECT_DOUBLE_EQ(p.minor + p.low + p.medium + p.high, 1);
    }
  }
}

double log_odds(const DamageEvidence& evidence) {
  return std::log(evidence.confidence() / (1 - evidence.confidence()));
}

// Each piece of evidence adds to the log-odds, whatever the others say; which by how much, `evaluate damage` tells.
TEST(DamageEvidence, EveryPieceCountsByItself) {
  const DamageEvidence sound{10, 40, 3, 1, 0};
  EXPECT_GT(sound.confidence(), (DamageEvidence{10, 39, 3, 1, 0}.confidence()));
  EXPECT_GT(sound.confidence(), (DamageEvidence{10, 40, 3, 0.9, 0}.confidence()));
  EXPECT_GT(sound.confidence(), (DamageEvidence{10, 40, 3, 1, 0.1}.confidence()));
  EXPECT_GT(sound.confidence(), (DamageEvidence{10, 40, 3, 1, 0, 0.1}.confidence()));
  const auto without_road = [](double significance) {
    return log_odds({10, significance, 3, 1, 0}) - log_odds({10, significance, 3, 0.5, 0});
  };
  EXPECT_NEAR(without_road(10), without_road(80), 1e-9);
  const auto at_border = [](double road_share) {
    return log_odds({10, 40, 3, road_share, 0}) - log_odds({10, 40, 3, road_share, 0.3});
  };
  EXPECT_NEAR(at_border(1), at_border(0.4), 1e-9);
  EXPECT_EQ((DamageEvidence{20, 100, 3, 1, 0}.confidence()), (DamageEvidence{90, 900, 3, 1, 0}.confidence()))
      << "more does not tell a pothole from a kerb";
}

// Half of a disc has 0.39 of its outline on the border that cuts it, a strip more.
TEST(DamageEvidence, BorderCutsWallsAndRelief) {
  DamageEvidence half{20, 40, 1.2, 1, 0.39}, strip{20, 100, 4, 1, 0.65}, sag{6, 90, 2, 0.95, 0.51};
  half.likely_wall_slope = strip.likely_wall_slope = 1;
  sag.likely_wall_slope = 0.15;
  EXPECT_GT(half.confidence(), 0.6) << "a pothole";
  EXPECT_LT(strip.confidence(), 0.3) << "a kerb";
  EXPECT_LT(sag.confidence(), 0.05) << "the road itself";
  const double steep = half.confidence();
  half.likely_wall_slope = 0.3;
  EXPECT_LT(half.confidence(), steep);
  DamageEvidence rut{10, 100, 2, 0.9, 0.2};
  rut.likely_wall_slope = 0.05;
  EXPECT_GT(rut.confidence(), 0.5) << "as wide as it is cut";
  rut.border_share = 0;
  EXPECT_GT(rut.confidence(), 0.9) << "depressions are gentle";
}

// A rut of 20 standard errors: a fifth of what gentle walls, the border and its extent say against damage is left.
TEST(DamageEvidence, RutsAreGentleAndRunOn) {
  DamageEvidence evidence{10, 60, 1.2, 1, 0.3};
  evidence.likely_wall_slope = 0.06;
  evidence.extent = 1.2;
  DamageEvidence steep = evidence;
  steep.likely_wall_slope = 0.3;
  steep.border_share = 0;
  steep.extent = 1;
  const double against = log_odds(steep) - log_odds(evidence);
  EXPECT_GT(against, 4);
  evidence.rut_significance = 20;
  EXPECT_NEAR(log_odds(steep) - log_odds(evidence), 0.2 * against, 1e-6);
}

TEST(DamageEvidence, DeepCompactRegionIsNeverVetoed) {
  EXPECT_GT((DamageEvidence{20, 150, 2.5, 0.4, 0}.confidence()), 0.8);
  EXPECT_LT((DamageEvidence{2, 6, 2, 1, 0}.confidence()), 0.2) << "as shallow as its surroundings are rough";
  EXPECT_LT((DamageEvidence{2, 8, 5, 0.1, 0}.confidence()), 0.1) << "beside the road";
  EXPECT_LT((DamageEvidence{200, 3000, 4, 1, 0.65}.confidence()), 0.2) << "a strip along the border: a kerb";
}

/// Map without a calibration.
DamageMap find_in(const Image<float>& transformed, const DamageOptions& options = {}) {
  DamageInput input;
  input.transformed = transformed;
  return find_damage(input, options);
}

using Position = std::array<int, 2>;

/// Map whose pixel (u, v) has the value at `source(u, v)`.
Image<float> resampled(const Image<float>& map, int width, int height,
                       const std::function<Position(int, int)>& source) {
  Image<float> result(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto [from_u, from_v] = source(u, v);
      result(u, v) = map(from_u, from_v);
    }
  }
  return result;
}

/// F of all damages of `found` against those of `expected`, whose position (u, v) is `source(u, v)`.
double overlap(const DamageMap& found, const DamageMap& expected, const std::function<Position(int, int)>& source) {
  double both = 0, one = 0;
  for (int v = 0; v < found.ids.height(); ++v) {
    for (int u = 0; u < found.ids.width(); ++u) {
      const auto [from_u, from_v] = source(u, v);
      const bool here = found.ids(u, v) != 0, there = expected.ids(from_u, from_v) != 0;
      both += here && there ? 2 : 0;
      one += (here ? 1 : 0) + (there ? 1 : 0);
    }
  }
  return both / one;
}

TEST(FindDamage, ScaleAndOffsetHaveNoEffect) {
  const DamageMap map = find_in(damaged().transformed);
  ASSERT_EQ(map.damages.size(), 2U);
  for (const float scale : {0.1F, 0.5F, 2.0F, 10.0F}) {
    Image<float> changed = damaged().transformed;
    for (int v = 0; v < changed.height(); ++v) {
      for (int u = 0; u < changed.width(); ++u) changed(u, v) = scale * changed(u, v) + 7;
    }
    const DamageMap other = find_in(changed);
    ASSERT_EQ(other.damages.size(), 2U) << scale;
    EXPECT_GE(overlap(other, map, [](int u, int v) { return Position{u, v}; }), 0.999) << scale;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(other.damages[k].confidence, map.damages[k].confidence, 0.01) << scale;
    }
  }
}

TEST(FindDamage, OrientationCropAndResolutionGiveSameRegions) {
  const DamageMap map = find_in(damaged().transformed);
  const auto check = [&](const char* name, int width, int height, const std::function<Position(int, int)>& source,
                         double min_overlap) {
    const DamageMap other = find_in(resampled(damaged().transformed, width, height, source));
    EXPECT_EQ(other.damages.size(), map.damages.size()) << name;
    EXPECT_GE(overlap(other, map, source), min_overlap) << name;
  };
  check(
      "mirrored", 640, 360,
      [](int u, int v) {
        return Position{639 - u, v};
      },
      0.98);
  check(
      "upside down", 640, 360,
      [](int u, int v) {
        return Position{u, 359 - v};
      },
      0.98);
  check(
      "cropped", 600, 340,
      [](int u, int v) {
        return Position{u + 21, v + 11};
      },
      0.97);
  check(
      "half size", 320, 180,
      [](int u, int v) {
        return Position{2 * u, 2 * v};
      },
      0.95);
}

/// A hole of 24 noise deviations around column 400 in which a third of the pixels has no value and the others scatter
/// between the road and twice the depth, as where matching fails on its walls; and the mask of it.
struct RaggedHole {
  Image<float> map;
  Image<std::uint8_t> inside;
};

RaggedHole ragged_hole(int width, int height, double centre_v, double radius) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  RaggedHole hole{with_noise(Image<float>(width, height, 30.0F), 1), Image<std::uint8_t>(width, height, 0)};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (std::hypot(u - 400.0, v - centre_v) > radius) continue;
      const float depth = 48 * share(random);
      float& value = hole.map(u, v);
      value = share(random) < 1.0F / 3 ? std::numeric_limits<float>::quiet_NaN() : value - depth;
      hole.inside(u, v) = 255;
    }
  }
  return hole;
}

/// F-measure of the pixels of damage.
double f_of(const DamageMap& found, const Image<std::uint8_t>& inside) {
  double both = 0, one = 0;
  for (int v = 0; v < inside.height(); ++v) {
    for (int u = 0; u < inside.width(); ++u) {
      both += found.ids(u, v) != 0 && inside(u, v) != 0 ? 2 : 0;
      one += (found.ids(u, v) != 0 ? 1 : 0) + (inside(u, v) != 0 ? 1 : 0);
    }
  }
  return both / one;
}

TEST(FindDamage, RaggedHoleIsFoundToItsRim) {
  const RaggedHole hole = ragged_hole(640, 360, 210, 40);
  const DamageMap found = find_in(hole.map);
  ASSERT_EQ(found.damages.size(), 1U);
  EXPECT_GT(found.damages[0].confidence, 0.9);
  EXPECT_GE(f_of(found, hole.inside), 0.9);
}

TEST(FindDamage, RaggedHoleIsFoundWhereBorderCutsIt) {
  // The lower border leaves more, half, and less of it; gaps of the hole reach the border.
  for (const int centre_v : {340, 359, 372}) {
    const RaggedHole hole = ragged_hole(640, 360, centre_v, 40);
    const DamageMap found = find_in(hole.map);
    ASSERT_EQ(found.damages.size(), 1U) << centre_v;
    EXPECT_TRUE(found.damages[0].cut_by_border);
    EXPECT_LT(found.damages[0].evidence.unseen_share, 0.1) << centre_v;
    // Chord and arc of the circle.
    const double half_angle = std::acos((centre_v - 359.5) / 40.0), chord = 2 * std::sin(half_angle);
    EXPECT_NEAR(found.damages[0].evidence.border_share, chord / (chord + 2 * half_angle), 0.12) << centre_v;
    EXPECT_GE(f_of(found, hole.inside), 0.85) << centre_v;
  }
}

/// Around a hole 20 mm deep the road undulates by 3 mm, 15 times its noise elsewhere. No damage is so shallow.
TEST(FindDamage, ReliefOfRoughRoadIsRoad) {
  constexpr int width = 640, height = 360;
  constexpr double road_px = 50;  // 500 px · 0.1 m below 1 m: 0.05 px a millimetre
  Image<float> transformed(width, height, 30.0F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double radius = std::hypot(u - 320, v - 180);
      if (radius <= 40) transformed(u, v) -= 1;
      if (radius > 40 && radius < 120) transformed(u, v) += ((u / 24 + v / 24) % 2 == 0 ? 0.15F : -0.15F);
    }
  }
  transformed = with_noise(transformed, 0.01);
  Image<float> disparity(width, height);
  std::transform(transformed.row(0), transformed.row(0) + transformed.pixels(), disparity.row(0),
                 [](float value) { return value - 30 + static_cast<float>(road_px); });
  DamageInput input;
  input.transformed = transformed;
  input.disparity = disparity;
  input.plane = DisparityPlane{road_px, 0, 0};
  input.calibration = StereoCalibration{500, 319.5, 179.5, 0.1, 0, width, height};
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_GT(map.damages[0].evidence.road_share, 0.9);
}

/// The right camera sees the road from column 50 on; left of it a quarter of the pixels have accidental matches below
/// the road. The border of that view cuts a pothole as the border of the image does.
TEST(FindDamage, HoleIsFoundWhereViewOfRightCameraCutsIt) {
  constexpr int width = 640, height = 360, first_u = 50, radius = 60;
  const Image<std::int16_t> right(width, height, std::int16_t{0});
  for (const int centre_u : {first_u + 40, first_u + 10, first_u - 10}) {
    Image<float> transformed(width, height, 30.0F);
    Image<std::uint8_t> inside(width, height, 0);
    std::mt19937 random(7);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (std::hypot(u - centre_u, v - 180) <= radius) transformed(u, v) -= 6;
        if (u >= first_u) {
          inside(u, v) = transformed(u, v) < 30 ? 255 : 0;
        } else {
          const auto draw = random() % 1000;
          transformed(u, v) = draw < 250 ? 18 + static_cast<float>(draw % 10) : std::numeric_limits<float>::quiet_NaN();
        }
      }
    }
    transformed = with_noise(transformed, 0.05);
    DamageInput input;
    input.transformed = transformed;
    input.right = right;
    input.plane = DisparityPlane{first_u, 0, 0};
    const DamageMap map = find_damage(input);
    ASSERT_EQ(map.damages.size(), 1U) << centre_u;
    const Damage& hole = map.damages[0];
    EXPECT_TRUE(hole.cut_by_border);
    EXPECT_EQ(hole.evidence.unseen_share, 0);
    // Chord and arc of the circle.
    const double half_angle = std::acos(static_cast<double>(first_u - centre_u) / radius),
                 chord = 2 * std::sin(half_angle);
    EXPECT_NEAR(hole.evidence.border_share, chord / (chord + 2 * half_angle), 0.08) << centre_u;
    EXPECT_NEAR(hole.evidence.road_share, 1, 0.05);
    EXPECT_GT(f_of(map, inside), 0.9) << centre_u;
  }
}

/// A gap that reaches the border of the image cuts a pothole through its middle: its rim is not known there. The same
/// cut by a gap that the road encloses is none.
TEST(FindDamage, GapThatReachesBorderIsBorder) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  DamageOptions options;
  options.min_confidence = 0;
  const DamageMap whole = find_damage(damaged().metric(), options);
  ASSERT_FALSE(whole.damages.empty());
  const Damage& pothole = whole.damages.front();
  EXPECT_EQ(pothole.evidence.unseen_share, 0);
  const auto [u0, v0, u1, v1] = pothole.box_px;
  const auto cut = [&](int first_u, int end_u) {
    Image<float> map = damaged().transformed;
    for (int v = v0 - 20; v <= v1 + 20; ++v) {
      for (int u = first_u; u < end_u; ++u) map(u, v) = nan;
    }
    DamageInput input = damaged().metric();
    input.transformed = map;
    return find_damage(input, options);
  };
  const int middle = (u0 + u1) / 2;
  const DamageMap at_border = cut(0, middle);
  ASSERT_FALSE(at_border.damages.empty());
  // The cut is a diameter of what is left, half an ellipse: a share of 1 / (1 + π/2) of a half circle's outline.
  EXPECT_NEAR(at_border.damages.front().evidence.unseen_share, 0.39, 0.12);
  EXPECT_LT(at_border.damages.front().confidence, whole.damages.front().confidence);
  const DamageMap enclosed = cut(u0 - 20, u0 + 4);
  ASSERT_FALSE(enclosed.damages.empty());
  EXPECT_EQ(enclosed.damages.front().evidence.unseen_share, 0);
}

TEST(FindDamage, CandidatesAreNotCounted) {
  DamageOptions options;
  options.min_confidence = 1;
  const DamageMap none = find_damage(damaged().metric(), options);
  EXPECT_TRUE(none.damages.empty());
  ASSERT_EQ(none.candidates.size(), 2U);
  EXPECT_EQ(none.ids, Image<std::uint16_t>(640, 360, 0));
  EXPECT_GT(none.candidates[0].confidence, 0.9);
  options.min_confidence = 0;
  const DamageMap all = find_damage(damaged().metric(), options);
  EXPECT_GE(all.damages.size(), 2U);
  EXPECT_TRUE(all.candidates.empty());
  for (const Damage& damage : all.damages)
    EXPECT_LE(damage.metrics->mean_depth_m.value, damage.metrics->max_depth_m.value);
}

/// Upper quartile of the depths over a standard error that is the same everywhere: with the true depths of the scene.
TEST(DamageEvidence, PixelSignificanceIsDepthInStandardErrors) {
  constexpr float sigma_px = 0.2F;
  const Image<float> sigma(640, 360, sigma_px);
  DamageInput input = damaged().metric();
  EXPECT_TRUE(std::isnan(find_damage(input).damages.at(0).evidence.pixel_significance)) << "the errors are unknown";
  input.sigma = sigma;
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) {
    std::vector<double> depths;
    for (int v = 0; v < map.ids.height(); ++v) {
      for (int u = 0; u < map.ids.width(); ++u) {
        if (map.ids(u, v) == damage.id) depths.push_back(std::abs(true_road_px - damaged().transformed(u, v)));
      }
    }
    std::sort(depths.begin(), depths.end());
    const double expected = depths[depths.size() * 3 / 4] / sigma_px;
    EXPECT_NEAR(damage.evidence.pixel_significance, expected, 0.1 * expected);
  }
}

TEST(DamageEvidence, DepthsOfAFewStandardErrorsAreLessLikelyDamage) {
  DamageEvidence evidence{20, 40, 3, 1, 0};
  const double unknown = evidence.confidence();
  const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
  evidence.pixel_significance = 5;
  EXPECT_EQ(evidence.confidence(), unknown);
  evidence.pixel_significance = 2.5;
  EXPECT_NEAR(log_odds(evidence.confidence()), log_odds(unknown) - 1.5 * std::log(2), 1e-6);
  evidence.pixel_significance = -3;
  EXPECT_NEAR(log_odds(evidence.confidence()), log_odds(unknown) - 1.5 * std::log(5), 1e-6);
}

/// A depth of which neither the maximum nor the mean is three of its standard errors is unresolvable, whatever its
/// confidence.
TEST(FindDamage, UnresolvableDepthIsCandidate) {
  const Image<float> sigma(640, 360, 0.99F);
  Image<float> shallow = damaged().transformed;  // the pothole is 2.9 px deep; so it is 0.48 px
  for (int v = 0; v < shallow.height(); ++v) {
    for (int u = 0; u < shallow.width(); ++u) shallow(u, v) /= 6;
  }
  DamageInput input = damaged().metric();
  input.transformed = shallow;
  input.sigma = sigma;
  const DamageMap map = find_damage(input);
  EXPECT_TRUE(map.damages.empty());
  ASSERT_FALSE(map.candidates.empty());
  for (const Damage& candidate : map.candidates) {
    EXPECT_EQ(candidate.metrics->severity, Severity::unresolvable);
    EXPECT_LT(candidate.metrics->max_depth_m.value, 3 * candidate.metrics->max_depth_m.std_error);
    EXPECT_LT(candidate.metrics->mean_depth_m.value, 3 * candidate.metrics->mean_depth_m.std_error);
  }
}

}  // namespace
}  // namespace roadstereo

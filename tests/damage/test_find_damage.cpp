// Damage found and measured in maps whose truth is exact, and what is no damage.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

TEST(FindDamage, MeasuresPotholeAndBump) {
  const DamageMap map = find_damage(damaged().metric());
  expect_truth(map, damaged().pair);
  EXPECT_GT(map.damages[0].metrics->max_depth_m.value, map.damages[1].metrics->max_depth_m.value) << "deepest first";
  EXPECT_NEAR(map.noise_px, 0.02 / 2, 0.002) << "of cells of 2×2 pixels";
}

/// The foot of a gentle wall cannot be told from the road: less is found, and the standard error says so.
TEST(FindDamage, GentleWallIsWithinStandardError) {
  synth::Scene scene = damaged_scene();
  for (synth::Blob& blob : scene.road.blobs) blob.wall_share = 0.6;
  const ExactMaps maps(scene);
  const DamageMap map = find_damage(maps.metric());
  for (const synth::DamageTruth& known : maps.pair.damages) {
    const Damage* found = find(map, maps.pair, known.id);
    ASSERT_NE(found, nullptr);
    expect_figure("area", found->metrics->area_m2, known.area_m2, 0.2);
    expect_figure("volume", found->metrics->volume_m3, known.volume_m3, 0.1);
    expect_figure("depth", found->metrics->max_depth_m, known.depth_m, 0.05);
  }
}

/// Mean of what a map knows over a Gaussian window.
Image<float> gaussian_mean(const Image<float>& map, double sigma_px) {
  const int radius = static_cast<int>(std::ceil(3 * sigma_px)), width = map.width(), height = map.height();
  const auto along = [&](const Image<float>& from, int step_u, int step_v) {
    Image<float> mean(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        double sum = 0, weights = 0;
        for (int k = -radius; k <= radius; ++k) {
          const int x = u + k * step_u, y = v + k * step_v;
          if (x < 0 || y < 0 || x >= width || y >= height || std::isnan(from(x, y))) continue;
          const double weight = std::exp(-0.5 * k * k / (sigma_px * sigma_px));
          sum += weight * double{from(x, y)};
          weights += weight;
        }
        mean(u, v) = static_cast<float>(sum / weights);
      }
    }
    return mean;
  };
  return along(along(map, 1, 0), 0, 1);
}

/// Matching averages over its window: a vertical wall becomes a slope, half of it outside the rim.
TEST(FindDamage, AverageMovesNoRim) {
  constexpr double window_sigma_px = 2;
  synth::Scene scene = damaged_scene();
  scene.rig.pitch_deg = 90;  // no wall hides another
  synth::Blob bump = scene.road.blobs[1];
  bump.x_m = bump.y_m = bump.irregularity = 0;
  bump.radius_m = 0.09;  // 36 pixels
  bump.wall_share = 0.02;
  scene.road.blobs = {bump};
  ExactMaps maps(scene);
  maps.transformed = gaussian_mean(maps.transformed, window_sigma_px);
  maps.disparity = gaussian_mean(maps.disparity, window_sigma_px);
  DamageInput input = maps.metric();
  input.smoothing_px = 6;  // a third of it is left at walls
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 1U);
  const DamageMetrics& metrics = *map.damages[0].metrics;
  const double area = std::numbers::pi * bump.radius_m * bump.radius_m;
  expect_figure("area", metrics.area_m2, area, 0.12);  // 0.22 where all that is deep counts
  expect_figure("volume", metrics.volume_m3, -area * bump.depth_m, 0.05);
  expect_figure("mean depth", metrics.mean_depth_m, -bump.depth_m, 0.08);
}

/// Cut by nothing, an outline's box has the extents that the true points have.
TEST(FindDamage, RoadBoxHasTrueExtents) {
  const DamageMap map = find_damage(damaged().metric());
  for (const synth::DamageTruth& known : damaged().pair.damages) {
    const Damage* found = find(map, damaged().pair, known.id);
    ASSERT_NE(found, nullptr);
    const auto [length, width, angle] = truth::extents(truth::points_of(damaged().pair, known.id).road);
    EXPECT_NEAR(found->metrics->length_m, std::max(length, width), 0.08 * length);
    EXPECT_LE(found->metrics->width_m, found->metrics->length_m);
    EXPECT_NEAR(found->metrics->width_m, std::min(length, width), 0.12 * width);
  }
}

TEST(FindDamage, MeasuresUnderRolledCamera) {
  synth::Scene scene = damaged_scene();
  scene.rig.pitch_deg = 90;
  scene.rig.roll_deg = 0;
  scene.road.blobs[0].y_m = 0.05;
  scene.road.blobs[1].y_m = -0.1;
  const ExactMaps nadir(scene);
  expect_truth(find_damage(nadir.metric()), nadir.pair);
  scene.rig.roll_deg = 12;  // turns the road's axes with it: only lengths are compared
  const ExactMaps turned(scene);
  const DamageMap map = find_damage(turned.metric());
  ASSERT_EQ(map.damages.size(), 2U);
  const double distance =
      std::hypot(map.damages[0].metrics->road_centroid_m[0] - map.damages[1].metrics->road_centroid_m[0],
                 map.damages[0].metrics->road_centroid_m[1] - map.damages[1].metrics->road_centroid_m[1]);
  const auto& known = turned.pair.damages;
  EXPECT_NEAR(distance, std::hypot(known[0].x_m - known[1].x_m, known[0].y_m - known[1].y_m), 0.01);
  for (const auto& one : map.damages) {
    const auto& same = known[one.kind == DamageKind::depression ? 0 : 1];
    expect_figure("volume", one.metrics->volume_m3, same.volume_m3, 0.1);
  }
}

/// An error of the disparities that belongs to every pixel is no damage, and changes no depth.
TEST(FindDamage, OffsetOfTransformedMapHasNoEffect) {
  ExactMaps shifted = damaged();
  for (int v = 0; v < shifted.transformed.height(); ++v) {
    for (int u = 0; u < shifted.transformed.width(); ++u) shifted.transformed(u, v) += 64;
  }
  const DamageMap map = find_damage(damaged().metric());
  const DamageMap other = find_damage(shifted.metric());
  ASSERT_EQ(other.damages.size(), map.damages.size());
  for (std::size_t k = 0; k < map.damages.size(); ++k) {
    const double depth = map.damages[k].metrics->max_depth_m.value;
    EXPECT_NEAR(other.damages[k].metrics->max_depth_m.value, depth, 0.005 * depth);
  }
}

/// Metric input of a road at δt = 30 px, seen straight down from 2 m: d = 50 px, f = 1000 px, b = 0.1 m.
struct FromAbove {
  Image<float> disparity;
  DamageInput input;

  explicit FromAbove(const Image<float>& transformed) : disparity(transformed) {
    const int width = transformed.width(), height = transformed.height();
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) disparity(u, v) += 20;
    }
    input.transformed = transformed;
    input.disparity = disparity;
    input.plane = DisparityPlane{50, 0, 0};
    input.calibration = StereoCalibration{1000, 0.5 * (width - 1), 0.5 * (height - 1), 0.1, 0, width, height};
  }
};

/// Deepest in the last row of a picture whose cells do not divide it: 1000 = 333·3 + 1.
TEST(FindDamage, DeepestPointIsInsideImage) {
  constexpr int width = 1300, height = 1000, radius = 90;
  Image<float> transformed(width, height, 30.0F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (std::hypot(u - 600.0, v - (height - 0.85 * radius)) > radius) continue;
      transformed(u, v) -= 2 + static_cast<float>((v - (height - 1.85 * radius)) / (0.925 * radius));
    }
  }
  transformed = with_noise(transformed, 0.02);
  const DamageMap map = find_damage(FromAbove(transformed).input);
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_TRUE(map.damages[0].cut_by_border);
  EXPECT_LT(map.damages[0].deepest_px[1], height);
  EXPECT_GE(map.damages[0].deepest_px[1], height - 9);
  // 4 px of 50: 2 m · 4 / 46
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 2 * 4 / 46.0, 0.02 * 2 * 4 / 46.0);
}

/// A paraboloid 2 px deep with a radius of 40 px, seen from above: half of its second difference over 12 px is
/// 2·12²/40² = 0.18 px along either axis.
TEST(FindDamage, SmoothingDoesNotMakeDepthUnresolvable) {
  constexpr int side = 320, smoothing_px = 12;
  constexpr double depth_px = 2, radius = 40, noise_px = 0.3, bias_px = 0.03, along_axis_px = 0.18;
  Image<float> transformed(side, side, 30.0F), sigma(side, side, static_cast<float>(noise_px));
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const double share = std::pow(std::hypot(u - 160, v - 160) / radius, 2);
      if (share > 1) continue;
      transformed(u, v) -= static_cast<float>(depth_px * (1 - share));
      sigma(u, v) = static_cast<float>(std::hypot(noise_px, along_axis_px, along_axis_px));
    }
  }
  transformed = with_noise(transformed, 0.002);
  FromAbove above(transformed);
  DamageInput& input = above.input;
  input.sigma = sigma;
  const double total_px = std::hypot(std::hypot(noise_px, along_axis_px, along_axis_px), bias_px);
  const DamageMap unknown = find_damage(input);
  input.smoothing_px = smoothing_px;
  const DamageMap known = find_damage(input);
  ASSERT_EQ(unknown.damages.size(), 1U);
  ASSERT_EQ(known.damages.size(), 1U);
  EXPECT_NEAR(unknown.damages[0].evidence.depth_significance, depth_px / total_px, 0.03 * depth_px / total_px);
  const double expected = depth_px / std::hypot(noise_px, bias_px);
  EXPECT_NEAR(known.damages[0].evidence.depth_significance, expected, 0.03 * expected);
  EXPECT_NEAR(known.damages[0].max_depth_px.std_error, total_px, 0.03 * total_px);
}

/// Matching that shifts rows by whole pixels errs by up to half of one in bands, where blocks straddle two shifts.
TEST(FindDamage, BandsOfErrorsDoNotDivideRoad) {
  ExactMaps maps(damaged_scene());
  for (int v = 0; v < maps.disparity.height(); ++v) {
    constexpr int spacing = 40, half_width = 2;
    const int phase = v % spacing - half_width;
    if (std::abs(phase) > half_width) continue;
    const float error = phase < 0 ? 0.4F : -0.4F;
    for (int u = 0; u < maps.disparity.width(); ++u) {
      maps.disparity(u, v) += error;
      maps.transformed(u, v) += error;
    }
  }
  const DamageMap map = find_damage(maps.metric());
  std::size_t road = 0;
  for (int v = 0; v < map.road.height(); ++v) {
    road += static_cast<std::size_t>(std::count(map.road.row(v), map.road.row(v) + map.road.width(), 255));
  }
  EXPECT_GT(static_cast<double>(road), 0.5 * static_cast<double>(map.road.pixels())) << "not one band of nine";
  ASSERT_EQ(map.damages.size(), 2U);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.06, 0.012);
}

// All of the road but what surrounds the pothole is noisier by three times.
TEST(FindDamage, NoiseElsewhereDoesNotHideDamage) {
  ExactMaps maps = damaged();
  const Damage quiet = find_damage(maps.metric()).damages.at(0);
  const auto [left, top, right, bottom] = quiet.box_px;
  const int margin = std::max(right - left, bottom - top) * 3 / 5;
  const Image<float> noisy = with_noise(maps.disparity, 0.06, 2);
  for (int v = 0; v < noisy.height(); ++v) {
    for (int u = 0; u < noisy.width(); ++u) {
      if (u >= left - margin && u <= right + margin && v >= top - margin && v <= bottom + margin) continue;
      maps.transformed(u, v) += noisy(u, v) - maps.disparity(u, v);
      maps.disparity(u, v) = noisy(u, v);
    }
  }
  const DamageMap found = find_damage(maps.metric());
  ASSERT_FALSE(found.damages.empty());
  EXPECT_EQ(found.damages[0].kind, DamageKind::depression);
  EXPECT_GT(found.noise_px, 0.015);
  const double all_road = found.damages[0].max_depth_px.value / found.noise_px;
  EXPECT_GT(found.damages[0].evidence.contrast_sigmas, 1.5 * all_road) << "standard deviations of all the road";
}

/// A bonnet over a fifth of a pothole, masked, is like the border of the image: not a gap, and not road that is
/// missing.
TEST(FindDamage, MaskEndsViewAsBorderDoes) {
  ExactMaps maps(damaged_scene());
  const DamageMap whole = find_damage(maps.metric());
  ASSERT_FALSE(whole.damages.empty());
  const auto& box = whole.damages[0].box_px;
  const int width = maps.disparity.width(), height = maps.disparity.height(), end = box[3] - (box[3] - box[1]) / 5;
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = end; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      maps.forget(u, v);
      mask(u, v) = 255;
    }
  }
  DamageInput input = maps.metric();
  const auto cut_pothole = [&] {
    DamageOptions options;
    options.min_confidence = 0;
    const DamageMap map = find_damage(input, options);
    const auto cut = std::find_if(map.damages.begin(), map.damages.end(), [&](const Damage& damage) {
      return damage.kind == DamageKind::depression && damage.box_px[3] >= end - 6;
    });
    EXPECT_NE(cut, map.damages.end());
    return cut == map.damages.end() ? Damage() : *cut;
  };
  const Damage beside_gap = cut_pothole();
  input.mask = mask;
  const Damage beside_mask = cut_pothole();
  EXPECT_TRUE(beside_mask.cut_by_border);
  EXPECT_GT(beside_mask.evidence.border_share, 0.1);
  EXPECT_EQ(beside_mask.evidence.unseen_share, 0);
  EXPECT_GT(beside_mask.confidence, 0.9);
  EXPECT_LT(beside_gap.confidence, beside_mask.confidence);
  EXPECT_NEAR(beside_mask.metrics->max_depth_m.value, whole.damages[0].metrics->max_depth_m.value, 0.01);
}

// A road that has caved in is the worst of its damage.
TEST(FindDamage, HoleOfHalfMetreIsFound) {
  constexpr double depth_m = 0.5;
  synth::Scene scene = damaged_scene();
  scene.rig.camera_height_m = 4;
  scene.rig.pitch_deg = 80;
  scene.road.blobs = {{0.1, 0.7, 0.4, depth_m, 0.1, 0.3, 3}};
  const ExactMaps maps(scene);
  const DamageMap map = find_damage(maps.metric());
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, depth_m, 0.03);
}

// Without disparities nothing says where the search for them ends.
TEST(FindDamage, RangeSearchedNeedsDisparities) {
  DamageInput input = damaged().pixels();
  input.disparity = {};
  input.shift = PerspectiveShift{.road = damaged().pair.plane, .delta_p = 1, .disparities = 8};
  const DamageMap map = find_damage(input);
  ASSERT_FALSE(map.damages.empty());
  for (const Damage& damage : map.damages) EXPECT_FALSE(damage.ends_search);
}

TEST(FindDamage, AppliesDepthAndAreaLimits) {
  DamageOptions options;
  options.min_depth_m = 0.05;  // the bump is 4 cm high
  EXPECT_EQ(find_damage(damaged().metric(), options).damages.size(), 1U);
  options = {};
  options.max_depth_m = 0.03;  // the pothole is 6 cm deep
  const DamageMap shallow = find_damage(damaged().metric(), options);
  ASSERT_EQ(shallow.damages.size(), 1U);
  EXPECT_EQ(shallow.damages[0].kind, DamageKind::protrusion);
  options = {};
  options.min_area_m2 = 1;
  const DamageMap none = find_damage(damaged().metric(), options);
  EXPECT_TRUE(none.damages.empty());
  // What is no damage is no intact road either: as before it was measured.
  const DamageMap all = find_damage(damaged().metric());
  std::size_t inside = 0, as_road = 0;
  for (int v = 0; v < all.ids.height(); ++v) {
    for (int u = 0; u < all.ids.width(); ++u) {
      if (all.ids(u, v) == 0) continue;
      ++inside;
      as_road += none.road(u, v) != 0 ? 1U : 0U;
      EXPECT_EQ(none.ids(u, v), 0);
    }
  }
  EXPECT_LT(as_road, inside / 5);  // the rim
  options = {};
  options.min_area_share = 0.5;
  EXPECT_TRUE(find_damage(damaged().pixels(), options).damages.empty());
}

TEST(FindDamage, UncalibratedMapHasNoMetrics) {
  const DamageMap map = find_damage(damaged().pixels());
  EXPECT_FALSE(map.metric);
  EXPECT_NE(map.non_metric_reason.find("calibration"), std::string::npos) << map.non_metric_reason;
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) EXPECT_FALSE(damage.metrics);
  // Outlines are drawn halfway up the wall where nothing says how deep a hollow really is.
  const synth::SyntheticPair& pair = damaged().pair;
  Image<std::uint16_t> deep = pair.labels;
  double floor_px = 0;
  const auto depth_px = [&](int u, int v) { return pair.plane.disparity(u, v) - pair.disparity(u, v); };
  for (int v = 0; v < deep.height(); ++v) {
    for (int u = 0; u < deep.width(); ++u) {
      if (deep(u, v) == 1) floor_px = std::max(floor_px, depth_px(u, v));
    }
  }
  for (int v = 0; v < deep.height(); ++v) {
    for (int u = 0; u < deep.width(); ++u) {
      if (deep(u, v) == 1 && depth_px(u, v) < 0.5 * floor_px) deep(u, v) = 0;
    }
  }
  EXPECT_GE(f_score(map.ids, find(map, pair, 1)->id, deep, 1), 0.93);
  DamageInput input = damaged().metric();
  input.disparity = {};
  EXPECT_NE(find_damage(input).non_metric_reason.find("disparity"), std::string::npos);
  input = damaged().metric();
  input.plane.reset();
  EXPECT_NE(find_damage(input).non_metric_reason.find("plane"), std::string::npos);
}

TEST(FindDamage, UnitOfUncalibratedMapHasNoEffect) {
  ExactMaps scaled = damaged();
  for (int v = 0; v < scaled.transformed.height(); ++v) {
    for (int u = 0; u < scaled.transformed.width(); ++u) {
      scaled.transformed(u, v) = 1000 * (scaled.transformed(u, v) + 4);
    }
  }
  const DamageMap map = find_damage(damaged().pixels());
  const DamageMap other = find_damage(scaled.pixels());
  ASSERT_EQ(map.damages.size(), other.damages.size());
  std::size_t different = 0;
  for (int v = 0; v < map.ids.height(); ++v) {
    for (int u = 0; u < map.ids.width(); ++u) different += map.ids(u, v) != other.ids(u, v) ? 1U : 0U;
  }
  EXPECT_LE(different, map.ids.pixels() / 50'000) << "float rounding moves single pixels at most";
  for (std::size_t k = 0; k < map.damages.size(); ++k) {
    const double depth = map.damages[k].max_depth_px.value;
    EXPECT_NEAR(other.damages[k].max_depth_px.value, 1000 * depth, depth);
  }
}

/// A copy of a map within a wider one that is full of nonsense.
template <class Value>
struct Padded {
  static constexpr int left = 5, right = 8;
  Image<Value> pixels;
  ImageView<const Value> view;

  Padded(const Image<Value>& map, Value nonsense) : pixels(map.width() + left + right, map.height(), nonsense) {
    for (int v = 0; v < map.height(); ++v) std::copy_n(map.row(v), map.width(), pixels.row(v) + left);
    view = {pixels.row(0) + left, map.width(), map.height(), pixels.width()};
  }
};

TEST(FindDamage, StridedViewsGiveSameResult) {
  const Image<float> sigma(640, 360, 0.03F);
  GreyImage grey;
  to_grey(damaged().pair.left.view(), 0, grey);
  DamageInput dense = damaged().metric();
  dense.sigma = sigma;
  dense.grey = grey;
  const Padded<float> transformed(damaged().transformed, 1e6F), disparity(damaged().disparity, -7.0F),
      noise(sigma, 9.0F);
  const Padded<std::int16_t> picture(grey, grey_max);
  DamageInput strided = dense;
  strided.transformed = transformed.view;
  strided.disparity = disparity.view;
  strided.sigma = noise.view;
  strided.grey = picture.view;
  const DamageMap map = find_damage(dense);
  EXPECT_EQ(map.damages.size(), 2U);
  expect_same(map, find_damage(strided));
}

}  // namespace
}  // namespace roadstereo

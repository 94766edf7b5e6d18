// Damage that is a match by chance: the picture shows something at a disparity that was not searched.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "damage/searched_range.hpp"
#include "roadstereo/pipeline.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// The damaged scene with a box of 0.3 m beside the damage, 18 pixels above the road, where the disparities claim a
/// hollow of two pixels: the road is searched 8 pixels down and 10 up.
struct HiddenBox {
  static constexpr int delta_p = 8, disparities = 19;
  static constexpr float depth_px = 2;
  ExactMaps maps;
  GreyImage left, right;
  int u = 0, v = 0;  ///< in the middle of the box's top

  HiddenBox() : maps(scene()) {
    to_grey(maps.pair.left.view(), 255, left);
    to_grey(maps.pair.right.view(), 255, right);
    const DisparityPlane& road = maps.pair.plane;
    double sum_u = 0, sum_v = 0, count = 0;
    for (int y = 0; y < left.height(); ++y) {
      for (int x = 0; x < left.width(); ++x) {
        const double at_road = road.disparity(x, y);
        if (!(double{maps.disparity(x, y)} - at_road > disparities - delta_p)) continue;
        const float noise = maps.disparity(x, y) - std::round(maps.disparity(x, y));
        maps.disparity(x, y) = static_cast<float>(at_road) - depth_px + 0.02F * noise;
        maps.transformed(x, y) = static_cast<float>(true_road_px) - depth_px + 0.02F * noise;
        sum_u += x;
        sum_v += y;
        ++count;
      }
    }
    u = static_cast<int>(sum_u / count);
    v = static_cast<int>(sum_v / count);
  }

  static synth::Scene scene() {
    synth::Scene scene = damaged_scene();
    synth::Box box;
    box.x_m = 0.05;
    box.y_m = 0.35;
    box.width_m = box.length_m = 0.2;
    box.top_m = 0.3;
    scene.road.boxes.push_back(box);
    return scene;
  }

  DamageInput input() const {
    DamageInput input = maps.metric();
    input.grey = left;
    input.right = right;
    return input;
  }
  PerspectiveShift shift() const { return {.road = maps.pair.plane, .delta_p = delta_p, .disparities = disparities}; }
};

const HiddenBox& hidden_box() {
  static const HiddenBox box;
  return box;
}

/// Vote of a square of 40×40 pixels around (u, v).
double vote_around(const DamageInput& input, int u, int v) {
  constexpr int radius = 20;
  const PixelBox box{u - radius, v - radius, u + radius - 1, v + radius - 1};
  DamageMap map = make_empty_damage_map(input.transformed.width(), input.transformed.height(), "");
  for (int y = box.v0; y <= box.v1; ++y) std::fill_n(map.ids.row(y) + box.u0, box.width(), std::uint16_t{1});
  return range_vote(input, map, 1, box);
}

TEST(SearchedRange, VotesAreForWhatThePicturesShow) {
  const HiddenBox& scene = hidden_box();
  DamageInput input = scene.input();
  EXPECT_TRUE(std::isnan(vote_around(input, scene.u, scene.v))) << "the range is unknown";
  input.shift = scene.shift();
  EXPECT_LT(vote_around(input, scene.u, scene.v), -0.9);
  constexpr int intact_u = 500, intact_v = 320;
  EXPECT_EQ(vote_around(input, intact_u, intact_v), 1);
  input.shift->disparities = 2 * HiddenBox::disparities;  // the top would have been found
  EXPECT_GT(vote_around(input, scene.u, scene.v), -0.9);
}

TEST(SearchedRange, RowOffsetIsUndone) {
  const HiddenBox& scene = hidden_box();
  constexpr int rows = 2;
  GreyImage lower(scene.right.width(), scene.right.height());
  for (int v = 0; v < lower.height(); ++v) {
    std::copy_n(scene.right.row(std::max(0, v - rows)), lower.width(), lower.row(v));
  }
  DamageInput input = scene.input();
  input.right = lower;
  input.shift = scene.shift();
  input.shift->misalignment.rows_px = rows;
  EXPECT_LT(vote_around(input, scene.u, scene.v), -0.9);
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 2U) << "the pothole and the bump of the scene";
  for (const Damage& damage : map.damages) {
    EXPECT_GT(damage.evidence.range_vote, 0.9);
    EXPECT_LT(damage.evidence.specular_excess, 0.02) << "a matte road";
  }
}

// Heights of which the camera at 1.5 m searches none: matched to noise over the whole top.
TEST(SearchedRange, PipelineTakesNoVehicleForAPothole) {
  for (const double height_m : {0.3, 0.5, 0.8}) {
    synth::Scene scene = intact_scene();
    synth::Box box;
    box.x_m = 0.1;
    box.y_m = 0.6;
    box.width_m = box.length_m = 0.5;
    box.top_m = height_m;
    scene.road.boxes.push_back(box);
    const synth::SyntheticPair pair = synth::render(scene);
    Pipeline pipeline(preset("default"), pair.calibration);
    ASSERT_TRUE(pipeline.process(pair.left.view(), pair.right.view()).roll_found);
    for (const Damage& damage : pipeline.find_damage().damages) {
      EXPECT_NE(damage.kind, DamageKind::depression) << height_m << " m: " << damage.confidence;
    }
  }
}

TEST(DamageEvidence, MatchByChanceIsNoDamage) {
  DamageEvidence evidence{20, 90, 3, 1, 0};
  const double unknown = evidence.confidence();
  EXPECT_GT(unknown, 0.95);
  evidence.range_vote = 0.35;
  EXPECT_EQ(evidence.confidence(), unknown);
  evidence.range_vote = 0;
  EXPECT_LT(evidence.confidence(), 0.5);
  evidence.range_vote = -0.3;
  EXPECT_LT(evidence.confidence(), 0.01);
}

}  // namespace
}  // namespace roadstereo

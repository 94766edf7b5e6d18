// Maps and options that find_damage rejects.

#include <gtest/gtest.h>

#include <limits>

#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

TEST(FindDamage, RejectsMapsWithoutContent) {
  const auto find_in = [](const Image<float>& map) {
    DamageInput input;
    input.transformed = map;
    find_damage(input);
  };
  expect_error([&] { find_in({}); }, "0×0");
  expect_error([&] { find_in(Image<float>(8, 8, 3.0F)); }, "8×8");
  expect_error([&] { find_in(Image<float>(64, 48, truth::nan_value)); }, "no valid pixel");
  expect_error([&] { find_in(Image<float>(64, 48, 3.5F)); }, "3.5");
  Image<float> few(64, 48, truth::nan_value);
  for (int u = 0; u < 20; ++u) few(u, 5) = static_cast<float>(u);
  expect_error([&] { find_in(few); }, "20");
}

/// A negative reach would read behind the rows.
TEST(FindDamage, RejectsReachOfSmoothing) {
  for (const int smoothing_px : {-1, 33}) {
    DamageInput input = damaged().metric();
    input.smoothing_px = smoothing_px;
    expect_error([&] { find_damage(input); }, "smoothing_px");
  }
}

TEST(FindDamage, RejectsViewsOfOtherSize) {
  const Image<float> other(640, 359, 1.0F);
  const GreyImage grey(639, 360, 1);
  DamageInput input = damaged().metric();
  input.disparity = other;
  expect_error([&] { find_damage(input); }, "disparity map has 640×359");
  input = damaged().metric();
  input.sigma = other;
  expect_error([&] { find_damage(input); }, "standard errors has 640×359");
  input = damaged().metric();
  input.grey = grey;
  expect_error([&] { find_damage(input); }, "image has 639×360");
  input = damaged().metric();
  input.calibration->width = 320;
  input.calibration->height = 180;
  expect_error([&] { find_damage(input); }, "320");
  input = damaged().metric();
  expect_error([&] { find_damage(input, {}, -1); }, "threads");
}

TEST(FindDamage, RejectsOptionsOutOfRange) {
  const auto refuse = [](const char* name, double DamageOptions::*option, double value) {
    DamageOptions options;
    options.*option = value;
    expect_error([&] { find_damage(damaged().metric(), options); }, name);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {-1.0, 0.5, 101.0, nan}) refuse("threshold_sigma", &DamageOptions::threshold_sigma, value);
  for (const double value : {-0.1, 11.0, nan}) refuse("min_depth_m", &DamageOptions::min_depth_m, value);
  for (const double value : {0.001, 11.0, nan}) refuse("max_depth_m", &DamageOptions::max_depth_m, value);
  for (const double value : {0.001, 11.0, nan}) refuse("max_height_m", &DamageOptions::max_height_m, value);
  for (const double value : {-1.0, 1e5, nan}) refuse("min_area_m2", &DamageOptions::min_area_m2, value);
  for (const double value : {-0.1, 1.1, nan}) refuse("min_area_share", &DamageOptions::min_area_share, value);
  for (const double value : {-0.1, 1.1, nan}) refuse("min_confidence", &DamageOptions::min_confidence, value);
}

}  // namespace
}  // namespace roadstereo

// The field of a rig's disparity errors: its values, its estimate from frames, its subtraction.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "roadstereo/damage.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo {
namespace {

constexpr int width = 160, height = 90;

double x_of(double u) {
  return (u - 79.5) / 80;
}
double y_of(double v) {
  return (v - 44.5) / 80;
}

RigBias bias_with(const std::array<double, RigBias::terms>& value_px) {
  RigBias bias;
  bias.width = width;
  bias.height = height;
  bias.order = 4;
  bias.value_px = value_px;
  bias.region_px = {0, 0, width - 1, height - 1};
  return bias;
}

TEST(RigBias, IsPolynomialUpToItsRegion) {
  const std::array<double, 15> c{0.3, -0.2, 0.5, 0.7, -0.1, 0.4, 0.25, -0.35, 0.15, 0.6, -0.45, 0.05, 0.85, -0.9, 0.33};
  RigBias bias = bias_with(c);
  const auto sum = [&](double u, double v) {
    const double x = x_of(u), y = y_of(v);
    return c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y + c[6] * x * x * x +
           c[7] * x * x * y + c[8] * x * y * y + c[9] * y * y * y + c[10] * x * x * x * x + c[11] * x * x * x * y +
           c[12] * x * x * y * y + c[13] * x * y * y * y + c[14] * y * y * y * y;
  };
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {159.0, 89.0}, {31.5, 70.25}}) {
    EXPECT_NEAR(bias.at(u, v), sum(u, v), 1e-12);
  }
  bias.region_px = {10, 30, 150, 80};
  EXPECT_NEAR(bias.at(0, 0), sum(10, 30), 1e-12);
  EXPECT_NEAR(bias.at(159, 85), sum(150, 80), 1e-12);
  EXPECT_NEAR(bias.at(60, 50), sum(60, 50), 1e-12);
}

TEST(RigBias, NamesWhatIsWrong) {
  const auto complaint = [](const std::function<void(RigBias&)>& spoil) -> std::string {
    RigBias bias = bias_with({});
    spoil(bias);
    try {
      bias.validate();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint([](RigBias&) {}), "");
  EXPECT_NE(complaint([](RigBias& bias) { bias.width = 0; }).find("rig_bias.width is 0"), std::string::npos);
  EXPECT_NE(complaint([](RigBias& bias) { bias.order = 5; }).find("rig_bias.order is 5"), std::string::npos);
  EXPECT_NE(complaint([](RigBias& bias) { bias.value_px[3] = NAN; }).find("rig_bias.value_px"), std::string::npos);
  EXPECT_NE(complaint([](RigBias& bias) { bias.region_px[0] = 200; }).find("rig_bias.region_px"), std::string::npos);
  EXPECT_THROW(RigBiasEstimator({.max_order = 5}), Error);
  EXPECT_THROW(RigBiasEstimator({.min_std_errors = 0}), Error);
  EXPECT_THROW(RigBiasEstimator({.min_frames = 3}), Error);
}

/// Frames of a road whose lower two thirds are seen: a plane, a field, a pothole that nobody marked, noise of 0.05 px,
/// and undulation that neighbouring frames share.
class KnownRoad {
 public:
  KnownRoad(const RigBias& truth, unsigned seed, double undulation_px) : truth_(truth), random_(seed) {
    undulation_px_ = undulation_px;
    for (double& term : undulation_) term = undulation_px_ * normal_(random_);
  }

  RigBiasFrame next() {
    constexpr double kept = 0.8;  // from frame to frame
    for (double& term : undulation_) {
      term = kept * term + std::sqrt(1 - kept * kept) * undulation_px_ * normal_(random_);
    }
    FrameResult frame;
    frame.roll_found = true;
    frame.delta_t = 7;
    frame.transformed.assign(width, height, NAN);
    frame.sigma.assign(width, height, 0.05F);
    DamageMap damage;
    damage.road.assign(width, height, 0);
    damage.ids.assign(width, height, 0);
    const double offset = 0.1 * normal_(random_), along_x = 0.1 * normal_(random_), along_y = 0.1 * normal_(random_);
    for (int v = height / 3; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double x = x_of(u), y = y_of(v);
        damage.road(u, v) = 255;
        double value = 7 + offset + along_x * x + along_y * y + truth_.at(u, v) + 0.05 * normal_(random_);
        value += undulation_[0] * x * x + undulation_[1] * x * y + undulation_[2] * y * y * y;
        if (std::hypot(u - 60, v - 60) < 10) value -= 3;
        frame.transformed(u, v) = static_cast<float>(value);
      }
    }
    return measure_rig_bias(frame, damage).value();
  }

 private:
  RigBias truth_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double undulation_px_;
  std::array<double, 3> undulation_{};
};

RigBias estimate_of(const RigBias& truth, unsigned seed, double undulation_px, int frames) {
  KnownRoad road(truth, seed, undulation_px);
  RigBiasEstimator estimator;
  for (int i = 0; i < frames; ++i) estimator.add(road.next());
  EXPECT_EQ(estimator.frames(), frames);
  return estimator.estimate(std::nullopt);
}

// Errors of the free coefficients in their standard errors, over recordings of 100 frames. The errors of an
// autoregression of 0.8 are three times those of independent frames.
TEST(RigBiasEstimator, HasErrorsThatCountFramesThatAreAlike) {
  const RigBias truth = bias_with({0, 0, 0, 0.2, 0, -0.1, 0.15, 0, 0.1, 0, 0.08});
  double squares = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const RigBias found = estimate_of(truth, seed, 0.02, 100);
    ASSERT_EQ(found.order, 4);
    for (std::size_t i = 3; i < RigBias::terms; ++i) {
      ASSERT_GT(found.std_error_px[i], 0);
      squares += std::pow((found.value_px[i] - truth.value_px[i]) / found.std_error_px[i], 2);
      ++count;
    }
  }
  const double rms = std::sqrt(squares / count);
  RecordProperty("rms_std_errors", std::to_string(rms));
  EXPECT_GT(rms, 0.7);
  EXPECT_LT(rms, 1.4);
}

TEST(RigBiasEstimator, LeavesPlaneOfRoad) {
  const RigBias found = estimate_of(bias_with({0, 0, 0, 0.2, 0, -0.1, 0.15}), 3, 0, 20);
  ASSERT_EQ(found.order, 3);
  double mean = 0, along_u = 0, along_v = 0, squares = 0;
  int count = 0;
  for (int v = height / 3 + 2; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double value = found.at(u, v);
      mean += value;
      along_u += value * x_of(u);
      along_v += value * (y_of(v) - y_of(60.5));
      squares += value * value;
      ++count;
    }
  }
  EXPECT_NEAR(mean / count, 0, 0.004);  // cells and the pothole weigh otherwise than pixels
  EXPECT_NEAR(along_u / count, 0, 0.004);
  EXPECT_NEAR(along_v / count, 0, 0.004);
  EXPECT_NEAR(found.rms_px, std::sqrt(squares / count), 0.05 * found.rms_px);
  EXPECT_LT(found.rms_std_error_px, 0.05 * found.rms_px);
}

TEST(RigBiasEstimator, FindsNoFieldInNoise) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const RigBias found = estimate_of(bias_with({}), seed, 0.02, 40);
    EXPECT_EQ(found.order, 0) << seed;
    EXPECT_EQ(found.at(10, 80), 0);
  }
  EXPECT_EQ(estimate_of(bias_with({0, 0, 0, 0.2}), 1, 0, 15).order, 0);  // too few frames
  EXPECT_EQ(estimate_of(bias_with({0, 0, 0, 0.2}), 1, 0, 16).order, 2);
}

// Batches are joined after 64 frames: 64 of one, 32 of two and so on tell the same.
TEST(RigBiasEstimator, JoinsFramesWithoutLoss) {
  KnownRoad road(bias_with({0, 0, 0, 0.2, 0, -0.1, 0, 0, 0, 0, 0.4}), 4, 0);
  const RigBiasFrame one = road.next(), other = road.next();
  RigBiasEstimator estimator;
  for (int i = 0; i < 1000; ++i) estimator.add(i % 2 == 0 ? one : other);
  RigBiasEstimator twice;
  for (int i = 0; i < 16; ++i) twice.add(i % 2 == 0 ? one : other);
  const RigBias many = estimator.estimate(std::nullopt), few = twice.estimate(std::nullopt);
  ASSERT_EQ(many.order, 4);
  ASSERT_EQ(few.order, 4);
  for (std::size_t i = 0; i < RigBias::terms; ++i) EXPECT_NEAR(many.value_px[i], few.value_px[i], 1e-9);
  RigBiasFrame smaller = one;
  smaller.width = 80;
  estimator.add(smaller);
  EXPECT_EQ(estimator.frames(), 1000);
}

TEST(RigBiasFrame, NeedsRoad) {
  FrameResult frame;
  DamageMap damage;
  EXPECT_FALSE(measure_rig_bias(frame, damage).has_value());
  frame.roll_found = true;
  frame.transformed.assign(width, height, 5);
  frame.sigma.assign(width, height, 0.1F);
  damage.road.assign(width, height, 0);
  damage.ids.assign(width, height, 0);
  EXPECT_FALSE(measure_rig_bias(frame, damage).has_value());
}

// ℓ' of the plane that is fitted anew differs; ℓ itself is the same but for the field.
TEST(Pipeline, SubtractsRigBias) {
  synth::Scene scene = synth::named_scene("uav");
  scene.rig.focal_px *= 160.0 / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
  scene.supersampling = 1;
  const synth::SyntheticPair pair = synth::render(scene);
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  Pipeline plain(options, pair.calibration);
  RigBias bias = bias_with({0.1, 0, 0, 0.2, 0, -0.1, 0.15});
  bias.focal_px = pair.calibration.focal_px;
  options.rig_bias = bias;
  Pipeline corrected(options, pair.calibration);
  const FrameResult& before = plain.process(pair.left.view(), pair.right.view());
  const FrameResult& after = corrected.process(pair.left.view(), pair.right.view());
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      ASSERT_EQ(std::isnan(before.disparity(u, v)), std::isnan(after.disparity(u, v)));
      if (std::isnan(before.disparity(u, v))) continue;
      ASSERT_NEAR(before.disparity(u, v) - after.disparity(u, v), bias.at(u, v), 1e-5);
    }
  }
  EXPECT_FALSE(before.rig_bias.has_value());
  EXPECT_TRUE(after.rig_bias.has_value());
}

TEST(Pipeline, RefusesBiasOfAnotherRig) {
  const synth::SyntheticPair pair = synth::render(synth::named_scene("uav"));
  const auto complaint = [&](const RigBias& bias) -> std::string {
    PipelineOptions options = preset("fast");
    options.rig_bias = bias;
    try {
      Pipeline(options, pair.calibration).process(pair.left.view(), pair.right.view());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  RigBias bias = bias_with({});
  EXPECT_NE(complaint(bias).find("the rig bias is that of 160×90 pixels"), std::string::npos) << complaint(bias);
  bias.width = pair.left.width;
  bias.height = pair.left.height;
  bias.focal_px = 1.002 * pair.calibration.focal_px;
  EXPECT_NE(complaint(bias).find("focal length"), std::string::npos) << complaint(bias);
  bias.focal_px = 1.0005 * pair.calibration.focal_px;
  EXPECT_EQ(complaint(bias), "");
}

}  // namespace
}  // namespace roadstereo

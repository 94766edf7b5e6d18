// Pairs of which one image is blurred more than the other: how much, and what the pipeline makes of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "roadstereo/blur_difference.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// Along rows and columns, by a sampled Gaussian in double precision.
Image<float> blurred(const Image<float>& image, double sigma_px) {
  if (sigma_px == 0) return image;
  const int radius = static_cast<int>(std::ceil(5 * sigma_px));
  std::vector<double> weights;
  double sum = 0;
  for (int k = -radius; k <= radius; ++k) sum += weights.emplace_back(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
  const auto pass = [&](const Image<float>& from, int du, int dv) {
    Image<float> to(from.width(), from.height());
    for (int v = 0; v < to.height(); ++v) {
      for (int u = 0; u < to.width(); ++u) {
        double value = 0;
        for (int k = -radius; k <= radius; ++k) {
          const int x = std::clamp(u + k * du, 0, to.width() - 1), y = std::clamp(v + k * dv, 0, to.height() - 1);
          value += weights[static_cast<std::size_t>(k + radius)] / sum * from(x, y);
        }
        to(u, v) = static_cast<float>(value);
      }
    }
    return to;
  };
  return pass(pass(image, 1, 0), 0, 1);
}

constexpr int width = 480, height = 270;

/// White texture seen through a lens, `shift` pixels aside, with noise of the sensor.
GreyImage texture(double sigma_px, double noise_grey, int shift, std::uint64_t noise_seed) {
  Image<float> image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image(u, v) = static_cast<float>(100 + 60 * test::lattice(u + shift, v, 5));
  }
  image = blurred(image, sigma_px);
  GreyImage grey(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double noise = noise_grey * std::sqrt(12) * (test::lattice(u, v, noise_seed) - 0.5);
      grey(u, v) = static_cast<std::int16_t>(std::lround(grey_scale * std::round(image(u, v) + noise)));
    }
  }
  return grey;
}

struct Blurs {
  double left_px, right_px, noise_grey;
};

class BlurOf : public testing::TestWithParam<Blurs> {};

TEST_P(BlurOf, DifferenceIsMeasured) {
  const auto [left_px, right_px, noise_grey] = GetParam();
  const GreyImage left = texture(left_px, noise_grey, 0, 11), right = texture(right_px, noise_grey, 24, 12);
  const double truth = right_px * right_px - left_px * left_px;
  const BlurDifference found = measure_blur_difference(left, right);
  ASSERT_TRUE(found.known());
  EXPECT_NEAR(found.variance_px2, truth, 4 * found.stderr_px2 + 0.02 * std::abs(truth));
  EXPECT_LT(found.stderr_px2, 0.03 + 0.1 * std::abs(truth));
  const BlurDifference exchanged = measure_blur_difference(right, left);
  EXPECT_NEAR(exchanged.variance_px2, -found.variance_px2, 1e-6 * (1 + std::abs(found.variance_px2)));
}

INSTANTIATE_TEST_SUITE_P(Pairs, BlurOf,
                         testing::Values(Blurs{0.7, 0.7, 0}, Blurs{0.7, 1.2, 1}, Blurs{1.5, 0.8, 1}, Blurs{1.1, 1.9, 2},
                                         Blurs{1.5, 1.5, 1}, Blurs{0.6, 2.5, 0.5}, Blurs{0.5, 0.7, 1}));

TEST(BlurDifference, IsUnknownWithoutTexture) {
  const GreyImage left = texture(1, 1, 0, 11), right = texture(1.5, 1, 24, 12);
  const GreyImage flat(width, height, std::int16_t{1000}), small(63, 200, std::int16_t{1000});
  EXPECT_FALSE(measure_blur_difference(flat, flat).known());
  EXPECT_FALSE(measure_blur_difference(small, small).known());
  EXPECT_FALSE(measure_blur_difference(texture(30, 3, 0, 11), texture(30, 3, 24, 12)).known()) << "noise alone";
  Image<std::uint8_t> mask(width, height, std::uint8_t{255});
  EXPECT_FALSE(measure_blur_difference(left, right, 0, mask).known());
  EXPECT_THROW(measure_blur_difference(left, small), Error);
}

/// The left half is a sharp overlay, such as a part of the vehicle.
TEST(BlurDifference, LeavesOutTheMask) {
  GreyImage left = texture(1, 1, 0, 11), right = texture(1.8, 1, 24, 12);
  const GreyImage sharp = texture(0.5, 0, 0, 11);
  Image<std::uint8_t> mask(width, height, std::uint8_t{0});
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width / 2; ++u) {
      right(u, v) = left(u, v) = sharp(u, v);
      mask(u, v) = 1;
    }
  }
  constexpr double truth = 1.8 * 1.8 - 1;
  EXPECT_LT(measure_blur_difference(left, right).variance_px2, 0.7 * truth);
  const BlurDifference found = measure_blur_difference(left, right, 0, mask);
  EXPECT_NEAR(found.variance_px2, truth, 4 * found.stderr_px2 + 0.02 * truth);
}

TEST(BlurDifference, HasTheSameBitsForAnyThreadCount) {
  const GreyImage left = texture(1, 2, 0, 11), right = texture(1.5, 2, 24, 12);
  const BlurDifference one = measure_blur_difference(left, right, 1), three = measure_blur_difference(left, right, 3);
  EXPECT_EQ(one.variance_px2, three.variance_px2);
  EXPECT_EQ(one.stderr_px2, three.stderr_px2);
}

/// A road whose views are blurred by different lenses.
struct DefocusedPair {
  synth::SyntheticPair pair;
  Image<float> truth;

  DefocusedPair(double left_px, double right_px, int frame = 0) : pair(rendered(frame)) {
    truth = Image<float>(pair.left.width, pair.left.height);
    for (int v = 0; v < truth.height(); ++v) {
      for (int u = 0; u < truth.width(); ++u) truth(u, v) = static_cast<float>(pair.disparity(u, v));
    }
    defocus(pair.left, left_px);
    defocus(pair.right, right_px);
  }

  static synth::SyntheticPair rendered(int frame) {
    synth::Scene scene = synth::named_scene("demo");
    scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
    scene.rig.height = scene.rig.height * width / scene.rig.width;
    scene.rig.width = width;
    return synth::render(synth::flight_frame(scene, {}, frame), 2);
  }

  static void defocus(Frame& frame, double sigma_px) {
    Image<float> image(frame.width, frame.height);
    std::copy(frame.bytes.begin(), frame.bytes.end(), image.row(0));
    image = blurred(image, sigma_px);
    for (std::size_t i = 0; i < frame.bytes.size(); ++i) {
      frame.bytes[i] = static_cast<std::uint8_t>(std::lround(image.row(0)[i]));
    }
  }

  /// RMS error, pixels, over what both cameras see.
  double error_of(const FrameResult& result) const {
    double sum = 0, count = 0;
    for (int v = 0; v < truth.height(); ++v) {
      for (int u = 0; u < truth.width(); ++u) {
        if (pair.visible(u, v) == 0 || std::isnan(result.disparity(u, v))) continue;
        const double error = result.disparity(u, v) - truth(u, v);
        sum += error * error;
        ++count;
      }
    }
    return std::sqrt(sum / count);
  }
};

TEST(EqualisedBlur, KeepsTheDisparitiesRight) {
  for (const auto& [left_px, right_px] : {std::pair{0.0, 1.6}, {1.6, 0.0}}) {
    const DefocusedPair defocused(left_px, right_px);
    PipelineOptions options = preset("default");
    Pipeline equalising(options, defocused.pair.calibration);
    options.equalise_blur = false;
    Pipeline plain(options, defocused.pair.calibration);
    const FrameResult& equal = equalising.process(defocused.pair.left.view(), defocused.pair.right.view());
    const FrameResult& unequal = plain.process(defocused.pair.left.view(), defocused.pair.right.view());
    const double truth = right_px * right_px - left_px * left_px;
    EXPECT_NEAR(equal.smoothed_px2, truth, 0.2 * std::abs(truth));
    EXPECT_NEAR(equal.smoothed_px2, equal.blur.variance_px2, 0.01);
    EXPECT_EQ(unequal.smoothed_px2, 0);
    EXPECT_FALSE(unequal.blur.known());
    RecordProperty("error_px", std::to_string(defocused.error_of(equal)));
    EXPECT_LT(defocused.error_of(equal), 0.8 * defocused.error_of(unequal)) << left_px;
  }
}

/// Between two measurements the last one holds, in a state that is restored, too.
TEST(EqualisedBlur, IsCarriedOver) {
  const DefocusedPair first(0, 1.6, 0), second(0, 1.6, 1);
  Pipeline pipeline(preset("default"), first.pair.calibration);
  const double measured = pipeline.process(first.pair.left.view(), first.pair.right.view()).smoothed_px2;
  ASSERT_GT(measured, 1);
  PipelineState state = pipeline.carried();
  EXPECT_EQ(state.blur_px2, measured);
  EXPECT_EQ(state.frames_since_blur, 1);
  const FrameResult& next = pipeline.process(second.pair.left.view(), second.pair.right.view());
  ASSERT_EQ(next.road.status, RoadStatus::tracked);
  EXPECT_FALSE(next.blur.known());
  EXPECT_EQ(next.smoothed_px2, measured);
  const Image<float> expected = next.disparity;
  Pipeline resumed(preset("default"), first.pair.calibration);
  resumed.restore(state);
  const FrameResult& again = resumed.process(second.pair.left.view(), second.pair.right.view());
  EXPECT_EQ(again.smoothed_px2, measured);
  EXPECT_TRUE(std::equal(again.disparity.row(0), again.disparity.row(0) + expected.pixels(), expected.row(0),
                         [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
  PipelineState lost = state;
  lost.road.reset();  // which tells nothing of the lenses
  resumed.restore(lost);
  const FrameResult& searched = resumed.process(second.pair.left.view(), second.pair.right.view());
  EXPECT_EQ(searched.road.status, RoadStatus::found);
  EXPECT_FALSE(searched.blur.known());
  EXPECT_EQ(searched.smoothed_px2, measured);
  state.frames_since_blur = 1000;
  resumed.restore(state);
  EXPECT_TRUE(resumed.process(second.pair.left.view(), second.pair.right.view()).blur.known());
  state.blur_px2 = 17;
  EXPECT_THROW(resumed.restore(state), Error);
}

/// A lens that was focused while the camera runs.
TEST(EqualisedBlur, EndsWithItsCause) {
  const DefocusedPair defocused(0, 1.6, 0), sharp(0, 0, 1);
  Pipeline pipeline(preset("default"), sharp.pair.calibration);
  pipeline.process(defocused.pair.left.view(), defocused.pair.right.view());
  PipelineState state = pipeline.carried();
  state.frames_since_blur = 1000;
  pipeline.restore(state);
  EXPECT_EQ(pipeline.process(sharp.pair.left.view(), sharp.pair.right.view()).smoothed_px2, 0);
  EXPECT_EQ(pipeline.carried().blur_px2, 0);
}

/// The finding is that of the cameras, not that of the images that were smoothed.
TEST(EqualisedBlur, LeavesTheHealthOfTheCameras) {
  const DefocusedPair defocused(0, 1.6);
  const auto blur_of = [&](bool equalise) {
    PipelineOptions options = preset("default");
    options.equalise_blur = equalise;
    Pipeline pipeline(options, defocused.pair.calibration);
    const FrameResult& result = pipeline.process(defocused.pair.left.view(), defocused.pair.right.view());
    const PairHealth health = measure_health(result, pipeline.find_damage(), defocused.pair.calibration);
    return std::pair{health.blur_left_px, health.blur_right_px};
  };
  const auto [left, right] = blur_of(true);
  const auto [expected_left, expected_right] = blur_of(false);
  EXPECT_NEAR(right, expected_right, 0.05);
  constexpr double limit = 1.5;  // of the finding
  EXPECT_GT(expected_right, limit * expected_left);
  EXPECT_GT(right, limit * left);
}

}  // namespace
}  // namespace roadstereo

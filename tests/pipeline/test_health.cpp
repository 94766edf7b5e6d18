// Faults of a rig, each put into an otherwise perfect pair.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pipeline/picture_health.hpp"
#include "pipeline/rectification_error.hpp"
#include "pipeline/stripe_noise.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/health.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// Points of a road 30 px away, with the vertical offsets of a fault of the right camera and noise of 0.1 px.
std::vector<RowSample> samples_of(const std::function<double(double x, double y, double left_x)>& offset_px) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<RowSample> samples;
  for (int v = 20; v < 360; v += 40) {
    for (int u = 60; u < 640; u += 40) {
      const double du = -10 - 0.1 * v;
      const double y = (v - 179.5) / 350;
      samples.push_back(
          {1.0 * u, 1.0 * v, du, offset_px((u + du - 319.5) / 350, y, (u - 319.5) / 350) + noise(random)});
    }
  }
  samples[7].dv += 20;  // a wrong match
  return samples;
}

RectificationError fit_of(const std::vector<RowSample>& samples) {
  const StereoCalibration calibration{.focal_px = 350, .cx_px = 319.5, .cy_px = 179.5, .baseline_m = 0.12};
  const auto fit = fit_rectification_error(samples, 640, 360, calibration);
  EXPECT_TRUE(fit.has_value());
  return fit.value_or(RectificationError{});
}

TEST(RectificationError, FindsScaleTurnAndDistortion) {
  const RectificationError scaled = fit_of(samples_of([](double, double y, double) { return 350 * 0.01 * y; }));
  EXPECT_NEAR(scaled.value[1], 0.01, 0.0006);
  EXPECT_TRUE(scaled.is_significant(1));
  const RectificationError turned = fit_of(samples_of([](double x, double, double) { return 350 * 0.0087 * x; }));
  EXPECT_NEAR(turned.value[2], 0.0087, 0.0004);
  const RectificationError bent =
      fit_of(samples_of([](double x, double y, double) { return 350 * 0.01 * y * (x * x + y * y); }));
  EXPECT_NEAR(bent.value[3], 0.01, 0.001);
  // At the border x = −0.9, y = 0.5 of the right view: 350 · 0.01 · 0.9 · 1.06 px.
  EXPECT_NEAR(bent.disparity_error_px(319.5 - 0.9 * 350, 179.5 + 0.5 * 350, 0), 3.339, 0.4);
  const RectificationError alike =
      fit_of(samples_of([](double x, double y, double left_x) { return 350 * -0.1 * y * (x * x - left_x * left_x); }));
  EXPECT_NEAR(alike.value[4], -0.1, 0.02);
  EXPECT_FALSE(alike.is_significant(3));
}

TEST(RectificationError, FindsNothingInNoise) {
  const RectificationError none = fit_of(samples_of([](double, double, double) { return 0.3; }));
  EXPECT_NEAR(350 * none.value[0], 0.3, 0.03);
  for (std::size_t term = 1; term < RectificationError::terms; ++term) EXPECT_FALSE(none.is_significant(term)) << term;
  EXPECT_EQ(none.disparity_error_px(0, 0, 20), 0);
  EXPECT_FALSE(fit_rectification_error(std::vector<RowSample>(19), 640, 360, std::nullopt).has_value());
  // Where texture repeats, blocks are found some rows off: they contradict each other.
  std::vector<RowSample> repeated;
  repeated.reserve(100);
  for (int k = 0; k < 100; ++k) repeated.push_back({k * 6.0, (k * 37) % 360 * 1.0, -20, 8.0 * (k % 5 - 2)});
  EXPECT_FALSE(fit_rectification_error(repeated, 640, 360, std::nullopt)->is_known());
  EXPECT_FALSE(neighbours_agree(repeated));
  for (RowSample& sample : repeated) sample.dv /= 80;
  EXPECT_TRUE(fit_rectification_error(repeated, 640, 360, std::nullopt)->is_known());
}

// A right camera that exposes after a way of a metre forwards: what is at depth z moves down by y / z of a metre. Left
// of the road stand walls, half as far as the road.
TEST(RectificationError, RowsOfAnotherMomentScatterAndNeighboursAgree) {
  std::vector<RowSample> samples = samples_of([](double, double, double) { return 0; });
  for (RowSample& sample : samples) {
    const double y = (sample.v - 179.5) / 350, depth_m = (sample.u < 300 ? 0.5 : 1) * 42 / -sample.du;
    sample.dv += 350 * y / depth_m;
  }
  EXPECT_FALSE(fit_of(samples).is_known());
  EXPECT_TRUE(neighbours_agree(samples));
  std::vector<RowSample> shuffled = samples;
  for (std::size_t k = 0; k < samples.size(); ++k) shuffled[k].dv = samples[k * 47 % samples.size()].dv;
  EXPECT_FALSE(neighbours_agree(shuffled));
}

/// The exact maps of the damaged scene as a frame.
struct ExactFrame {
  FrameResult frame;
  DamageMap damage;

  explicit ExactFrame(const std::function<void(Frame& left, Frame& right)>& fault = [](Frame&, Frame&) {}) {
    Frame left = damaged().pair.left, right = damaged().pair.right;
    fault(left, right);
    to_grey(left.view(), 255, frame.grey);
    to_grey(right.view(), 255, frame.right);
    frame.disparity = damaged().disparity;
    frame.transformed = damaged().transformed;
    frame.sigma.assign(frame.disparity.width(), frame.disparity.height(), 0.03F);
    frame.geometry.plane = damaged().pair.plane;
    frame.roll_found = true;
    damage = find_damage(damaged().metric());
  }

  PairHealth health() const { return measure_health(frame, damage, damaged().pair.calibration); }
  /// Ids of the findings, joined.
  std::string found() const {
    std::string ids;
    for (const HealthFinding& finding : health().findings()) ids += finding.id + " ";
    return ids;
  }
};

/// What lies over a texture.
enum class Scenery { none, shadows, dark_quarter };

/// White noise blurred by a Gaussian, with the contrast of asphalt, below soft shadows, or with noise and a dark
/// quarter.
Frame blurred_texture(int width, int height, double sigma_px, Scenery scenery) {
  std::mt19937 random(5);
  std::normal_distribution<float> white;
  Image<float> texture(width, height);
  for (int v = 0; v < height; ++v) std::generate_n(texture.row(v), width, [&] { return white(random); });
  const auto blur = [&](int du, int dv) {
    const int reach = static_cast<int>(std::ceil(4 * sigma_px));
    Image<float> sum(width, height, 0);
    for (int k = -reach; k <= reach; ++k) {
      const auto weight = static_cast<float>(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
      for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
          sum(u, v) += weight * texture((u + k * du + width) % width, (v + k * dv + height) % height);
        }
      }
    }
    texture = sum;
  };
  blur(1, 0);
  blur(0, 1);
  // The squares of the weights have the sum √π σ in either direction.
  const double unit = std::sqrt(std::numbers::pi) * sigma_px;
  Frame frame{{}, width, height};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double shade = std::tanh(0.15 * (std::min(u % 160, 160 - u % 160) - 40));
      double grey = 120 + 12 * double{texture(u, v)} / unit;
      if (scenery == Scenery::shadows) grey += 60 * shade;
      if (scenery == Scenery::dark_quarter) {
        const bool is_dark = u < width / 2 && v < height / 2;
        grey = (is_dark ? 0.25 : 1) * grey + double{white(random)};
      }
      frame.bytes.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L)));
    }
  }
  return frame;
}

/// Blur that is measured on a road that fills a picture of that size.
double measured_blur(int width, int height, double sigma_px, Scenery scenery) {
  FrameResult frame;
  to_grey(blurred_texture(width, height, sigma_px, scenery).view(), 255, frame.grey);
  frame.right = frame.grey;
  frame.disparity.assign(width, height, 1);
  DamageMap damage = make_empty_damage_map(width, height, "");
  std::fill_n(damage.road.row(0), damage.road.pixels(), std::uint8_t{255});
  PairHealth health;
  measure_pictures(frame, damage, 1, health);
  return health.blur_left_px;
}

TEST(MeasureHealth, BlurIsThatOfTheTextureNotOfWhatLiesOverIt) {
  // A tile has some hundred differences: their mean square is known to 0.1, and a tenth of the tiles exceed 1.3 times
  // that.
  constexpr double tolerance = 0.2;
  for (const double sigma_px : {1.0, 1.5, 2.5}) {
    for (const Scenery scenery : {Scenery::none, Scenery::shadows, Scenery::dark_quarter}) {
      EXPECT_NEAR(measured_blur(640, 360, sigma_px, scenery), sigma_px, tolerance * sigma_px)
          << static_cast<int>(scenery);
    }
    EXPECT_NEAR(measured_blur(360, 640, sigma_px, Scenery::none), sigma_px, tolerance * sigma_px) << "upright";
    EXPECT_NEAR(measured_blur(720, 1280, sigma_px, Scenery::none), sigma_px, tolerance * sigma_px) << "upright, larger";
  }
}

TEST(MeasureHealth, PerfectPairHasNoFinding) {
  const ExactFrame exact;
  EXPECT_EQ(exact.found(), "");
  const PairHealth health = exact.health();
  EXPECT_TRUE(health.depth_is_trusted());
  EXPECT_NEAR(health.gain, 1, 0.01);
  EXPECT_NEAR(health.row_offset_px, 0, 0.05);
  EXPECT_NEAR(health.blur_left_px, health.blur_right_px, 0.05);
}

TEST(MeasureHealth, ExposureIsMeasured) {
  const ExactFrame dark([](Frame&, Frame& right) {
    for (std::uint8_t& level : right.bytes) level = static_cast<std::uint8_t>(level / 4);
  });
  EXPECT_NEAR(dark.health().gain, 0.25, 0.01);
  EXPECT_EQ(dark.found(), "gain ");
  const ExactFrame clipped([](Frame& left, Frame&) {
    for (std::size_t k = 0; k < left.bytes.size(); k += 5) left.bytes[k] = 255;
  });
  EXPECT_NEAR(clipped.health().clipped_left, 0.2, 0.02);
  EXPECT_NE(clipped.found().find("clipped"), std::string::npos);
}

// The largest level of 10 bits, shifted to the top of 16.
TEST(MeasureHealth, WhiteOfTenBitsIsClipped) {
  ExactFrame exact;
  constexpr int side = 32;
  Frame white{{}, side, side, SampleType::u16, ChannelOrder::grey};
  for (int k = 0; k < side * side; ++k) white.bytes.insert(white.bytes.end(), {0xC0, 0xFF});
  GreyImage level;
  to_grey(white.view(), 65535, level);
  for (int u = 0; u < exact.frame.grey.width(); u += 5) {
    for (int v = 0; v < exact.frame.grey.height(); ++v) exact.frame.grey(u, v) = level(0, 0);
  }
  EXPECT_NEAR(exact.health().clipped_left, 0.2, 0.02);
}

TEST(MeasureHealth, NoiseIsShareOfVariance) {
  const auto health_with = [](double sigma) {
    const ExactFrame noisy([sigma](Frame& left, Frame& right) {
      std::mt19937 random(5);
      std::normal_distribution<double> noise(0, sigma);
      for (Frame* const frame : {&left, &right}) {
        for (std::uint8_t& level : frame->bytes)
          level = static_cast<std::uint8_t>(std::clamp(std::lround(level + noise(random)), 0L, 255L));
      }
    });
    return std::pair(noisy.health(), noisy.found());
  };
  const auto [none, without] = health_with(0);
  const auto [little, still_without] = health_with(3);
  const auto [much, noisy] = health_with(20);
  EXPECT_LT(none.noise_share, 0.15);  // sub-pixel parts of the disparity, at the finest texture
  EXPECT_EQ(still_without, "");
  EXPECT_EQ(noisy, "noise ");
  // N / (S + N): S is the variance of the clean picture's blocks.
  const double texture = 400 * (1 - much.noise_share) / much.noise_share;
  EXPECT_NEAR(little.noise_share - none.noise_share * texture / (texture + 9), 9 / (texture + 9), 0.03);
  EXPECT_TRUE(much.depth_is_trusted());
}

// A gain of the right view changes its noise and its texture alike. The darker levels are rounded to whole ones, too.
TEST(MeasureHealth, NoiseIsThatOfViewsOfOneGain) {
  const auto share_with = [](double gain) {
    const ExactFrame noisy([gain](Frame& left, Frame& right) {
      std::mt19937 random(5);
      std::normal_distribution<double> noise(0, 8);
      for (Frame* const frame : {&left, &right}) {
        const double factor = 0.5 * (frame == &right ? gain : 1);  // not above 255
        for (std::uint8_t& level : frame->bytes)
          level = static_cast<std::uint8_t>(std::clamp(std::lround(factor * (level + noise(random))), 0L, 255L));
      }
    });
    return noisy.health().noise_share;
  };
  const double alike = share_with(1);
  EXPECT_GT(alike, 0.05);
  for (const double gain : {0.55, 1.8}) EXPECT_NEAR(share_with(gain), alike, 0.1 * alike) << gain;
}

// Every column, or row, of either sensor has its own offset of 2 grey levels, standard deviation.
TEST(MeasureHealth, NoiseOfColumnsAndRowsIsShareOfVariance) {
  const double none = ExactFrame().health().stripe_share;
  EXPECT_LT(none, 0.02);
  for (const bool of_columns : {true, false}) {
    const auto striped = [of_columns](double sigma) {
      return ExactFrame([=](Frame& left, Frame& right) {
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0, sigma);
        for (Frame* const frame : {&left, &right}) {
          std::vector<double> offsets(static_cast<std::size_t>(of_columns ? frame->width : frame->height));
          std::generate(offsets.begin(), offsets.end(), [&] { return noise(random); });
          for (std::size_t k = 0; k < frame->bytes.size(); ++k) {
            const auto width = static_cast<std::size_t>(frame->width);
            const double level = frame->bytes[k] + offsets[of_columns ? k % width : k / width];
            frame->bytes[k] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
          }
        }
      });
    };
    const ExactFrame little = striped(2), much = striped(20);
    // The variance of 360 numbers is known to 7 %. Levels are sixteenths.
    EXPECT_NEAR(stripe_variance(little.frame.grey, little.damage.road), 4 * 256, 0.2 * 4 * 256) << of_columns;
    EXPECT_GT(little.health().stripe_share, 2 * none) << of_columns;
    EXPECT_EQ(little.found(), "") << of_columns;
    EXPECT_GT(much.health().stripe_share, 0.5) << of_columns;
    EXPECT_NE(much.found().find("noise"), std::string::npos) << of_columns;
  }
}

// Rows that matching has undone are compared where they lie in the right view.
TEST(MeasureHealth, RowOffsetIsNoNoise) {
  constexpr int rows = 2;
  ExactFrame lowered([](Frame&, Frame& right) {
    const auto offset = static_cast<std::ptrdiff_t>(rows) * right.width;
    std::copy_backward(right.bytes.begin(), right.bytes.end() - offset, right.bytes.end());
  });
  const double not_undone = lowered.health().noise_share;
  lowered.frame.shift.misalignment.rows_px = rows;
  EXPECT_NEAR(lowered.health().noise_share, ExactFrame().health().noise_share, 0.01);
  EXPECT_GT(not_undone, lowered.health().noise_share + 0.1);
}

TEST(MeasureHealth, DamageOfAnotherSizeIsRejected) {
  ExactFrame exact;
  exact.damage = make_empty_damage_map(64, 48, "");
  EXPECT_THROW((void)exact.health(), Error);
}

TEST(MeasureHealth, BlocksAreCompression) {
  constexpr int block = 8;
  const auto quantise = [](Frame& frame) {
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        const auto at = [&](int x, int y) -> std::uint8_t& {
          return frame
              .bytes[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x)];
        };
        at(u, v) = static_cast<std::uint8_t>((at(u, v) + at(u - u % block, v - v % block)) / 2);
      }
    }
  };
  const ExactFrame blocks([&](Frame& left, Frame& right) {
    quantise(left);
    quantise(right);
  });
  EXPECT_NE(blocks.found().find("compression"), std::string::npos);
  // Cropped after its compression: the blocks begin three columns and five rows further.
  const ExactFrame cropped([&](Frame& left, Frame& right) {
    for (Frame* const frame : {&left, &right}) {
      const std::ptrdiff_t shift = 5 * std::ptrdiff_t{frame->width} + 3;
      std::rotate(frame->bytes.begin(), frame->bytes.begin() + shift, frame->bytes.end());
      quantise(*frame);
      std::rotate(frame->bytes.begin(), frame->bytes.end() - shift, frame->bytes.end());
    }
  });
  EXPECT_NEAR(cropped.health().blocks_left, blocks.health().blocks_left, 0.1 * blocks.health().blocks_left);
  EXPECT_NE(cropped.found().find("compression"), std::string::npos);
}

TEST(PairHealth, UnknownViewHidesNoFault) {
  for (const bool left : {false, true}) {
    PairHealth health;
    (left ? health.blocks_left : health.blocks_right) = 0.9;
    (left ? health.blur_left_px : health.blur_right_px) = 5;
    ASSERT_EQ(health.findings().size(), 2U);
    EXPECT_EQ(health.findings()[0].id, "blur");
    EXPECT_EQ(health.findings()[1].id, "compression");
  }
}

TEST(PairHealth, RowsThatScatterSpoilDepth) {
  PairHealth health;
  health.row_scatter_px = 0.9;
  EXPECT_TRUE(health.depth_is_trusted());
  health.row_scatter_px = 1.1;
  ASSERT_EQ(health.findings().size(), 1U);
  EXPECT_EQ(health.findings()[0].id, "row-scatter");
  EXPECT_FALSE(health.depth_is_trusted());
}

/// Sides at which one line in 32 is taken, where whole bands have one.
TEST(PairHealth, StripesOfLargePicturesAreMeasured) {
  constexpr int width = 300;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 2 * 16);
  std::vector<std::int16_t> of_column(width);
  for (std::int16_t& level : of_column) level = static_cast<std::int16_t>(std::lround(1600 + noise(random)));
  for (const int height : {4095, 4096, 8192}) {
    GreyImage grey(width, height);
    for (int v = 0; v < height; ++v) std::copy(of_column.begin(), of_column.end(), grey.row(v));
    const Image<std::uint8_t> road(width, height, 255);
    EXPECT_NEAR(stripe_variance(grey, road), 4 * 256, 0.3 * 4 * 256) << height;  // 300 columns tell it to 12 %
  }
}

TEST(PairHealth, NoiseOfPixelsAndStripesAddUp) {
  PairHealth health;
  health.noise_share = 0.2;
  EXPECT_TRUE(health.findings().empty());
  health.stripe_share = 0.1;
  ASSERT_EQ(health.findings().size(), 1U);
  EXPECT_EQ(health.findings()[0].id, "noise");
  EXPECT_NEAR(health.findings()[0].value, 0.3, 1e-12);
}

TEST(PairHealth, GridOfBlocksAsStrongAsTextureSpoilsDepth) {
  PairHealth health;
  health.blocks_left = health.blocks_right = 0.9;
  EXPECT_TRUE(health.depth_is_trusted());
  health.blocks_right = 1.1;
  EXPECT_FALSE(health.depth_is_trusted());
}

TEST(MeasureHealth, LoweredViewSpoilsDepth) {
  constexpr int rows = 2;
  const ExactFrame lowered([](Frame&, Frame& right) {
    const auto width = static_cast<std::ptrdiff_t>(right.width);
    std::copy_backward(right.bytes.begin(), right.bytes.end() - rows * width, right.bytes.end());
  });
  EXPECT_NEAR(lowered.health().row_offset_px, rows, 0.1);
  EXPECT_NE(lowered.found().find("row-error"), std::string::npos);
  ASSERT_FALSE(lowered.health().depth_is_trusted());
  DamageMap damage = lowered.damage;
  ASSERT_FALSE(damage.damages.empty());
  withhold_severity(lowered.health(), damage);
  for (const Damage& one : damage.damages) {
    EXPECT_EQ(one.metrics->severity, Severity::unknown);
    EXPECT_EQ(one.metrics->severity_probabilities.high, 0);
  }
}

TEST(MeasureHealth, WaveOfRowsIsVibration) {
  ExactFrame shaken;
  for (int v = 0; v < shaken.frame.transformed.height(); ++v) {
    const auto wave = static_cast<float>(0.4 * std::sin(2 * std::numbers::pi * 6 * v / 360));
    for (int u = 0; u < shaken.frame.transformed.width(); ++u) shaken.frame.transformed(u, v) += wave;
  }
  DamageInput input = damaged().metric();
  input.transformed = shaken.frame.transformed;
  shaken.damage = find_damage(input);
  // The median of |sin| is 1/√2; 1.4826 of it is the robust deviation.
  EXPECT_NEAR(shaken.health().wave_px, 1.4826 * 0.4 / std::numbers::sqrt2, 0.03);
  EXPECT_NE(shaken.found().find("wave"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo

// Masks, and black borders of the pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/synth.hpp"
#include "tests/pipeline/synthetic_truth.hpp"

namespace roadstereo {
namespace {

/// Masks the lower third, from a row on that is not matched: what is interpolated between has no σ either.
Image<std::uint8_t> lower_third(int width, int height) {
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 2 * height / 3 | 1; v < height; ++v) std::fill_n(mask.row(v), width, std::uint8_t{255});
  return mask;
}

TEST(PipelineMask, MaskedPixelsHaveNeitherDisparityNorDamage) {
  const synth::SyntheticPair pair = test::named_pair("demo");
  const Image<std::uint8_t> mask = lower_third(pair.left.width, pair.left.height);
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  Pipeline pipeline(options, pair.calibration);
  const auto damaged = [&pipeline](ImageView<const std::uint8_t> inside) {
    const DamageMap damage = pipeline.find_damage();
    int pixels = 0;
    for (int v = 0; v < inside.height(); ++v) {
      for (int u = 0; u < inside.width(); ++u) pixels += inside(u, v) != 0 && damage.ids(u, v) != 0;
    }
    return pixels;
  };
  pipeline.process(pair.left.view(), pair.right.view());
  ASSERT_GT(damaged(mask), 0);
  pipeline.reset();
  pipeline.set_mask(mask);
  for (const RoadStatus status : {RoadStatus::found, RoadStatus::tracked}) {
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    EXPECT_EQ(result.road.status, status);
    std::size_t masked = 0, known = 0;
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        if (mask(u, v) == 0) {
          known += !std::isnan(result.disparity(u, v));
          continue;
        }
        masked += std::isnan(result.disparity(u, v)) && std::isnan(result.sigma(u, v)) &&
                  std::isnan(result.transformed(u, v));
      }
    }
    EXPECT_EQ(masked, static_cast<std::size_t>(std::count(mask.row(0), mask.row(0) + mask.pixels(), 255)));
    EXPECT_GT(known, (mask.pixels() - masked) * 9 / 10);
    EXPECT_EQ(damaged(mask), 0);
    // Damages are numbered by their order, and ids are those of damages.
    const DamageMap damage = pipeline.find_damage();
    std::vector<std::size_t> pixels(damage.damages.size() + 1);
    for (int v = 0; v < mask.height(); ++v) {
      for (int u = 0; u < mask.width(); ++u) {
        ASSERT_LT(damage.ids(u, v), pixels.size());
        ++pixels[damage.ids(u, v)];
      }
    }
    for (std::size_t k = 0; k < damage.damages.size(); ++k) {
      EXPECT_EQ(damage.damages[k].id, static_cast<int>(k) + 1);
      EXPECT_GT(2 * pixels[k + 1], damage.damages[k].pixels);
    }
    EXPECT_LT(std::abs(result.geometry.roll_rad - pair.roll_rad), 0.006);
  }
  pipeline.set_mask({});
  pipeline.process(pair.left.view(), pair.right.view());
  EXPECT_GT(damaged(mask), 0);
}

// What lies under a mask, a dark or a bright bonnet, tells nothing of the pothole that it cuts.
TEST(PipelineMask, GreyUnderMaskHasNoInfluence) {
  synth::SyntheticPair pair = test::named_pair("demo");
  const int width = pair.left.width, height = pair.left.height;
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  const auto damages_under = [&](const Image<std::uint8_t>& mask, const std::optional<std::uint8_t>& grey) {
    Frame left = pair.left;
    const std::size_t channels = left.bytes.size() / static_cast<std::size_t>(width * height);
    for (int v = 0; v < height && grey; ++v) {
      for (int u = 0; u < width; ++u) {
        if (mask(u, v) == 0) continue;
        std::fill_n(left.bytes.begin() + static_cast<std::ptrdiff_t>(v * width + u) * std::ptrdiff_t(channels),
                    channels, *grey);
      }
    }
    Pipeline pipeline(options, pair.calibration);
    pipeline.set_mask(mask);
    pipeline.process(left.view(), pair.right.view());
    return pipeline.find_damage().damages;
  };
  Pipeline whole(options, pair.calibration);
  whole.process(pair.left.view(), pair.right.view());
  const DamageMap damage = whole.find_damage();
  ASSERT_FALSE(damage.damages.empty());
  const auto& box = damage.damages[0].box_px;
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = box[3] - (box[3] - box[1]) / 5; v < height; ++v) std::fill_n(mask.row(v), width, std::uint8_t{255});
  for (const int grey : {20, 90, 250}) {
    const std::vector<Damage> found = damages_under(mask, static_cast<std::uint8_t>(grey));
    const auto cut = std::find_if(found.begin(), found.end(), [&](const Damage& each) {
      return each.kind == damage.damages[0].kind && each.centroid_px[0] > box[0] && each.centroid_px[0] < box[2];
    });
    ASSERT_NE(cut, found.end()) << grey;
    EXPECT_TRUE(cut->cut_by_border);
    EXPECT_NEAR(cut->metrics->max_depth_m.value, damage.damages[0].metrics->max_depth_m.value, 0.01);
  }
}

/// Bars beside the picture match where they stand, at a disparity of 0: that is no evidence against the road.
TEST(Pipeline, FindsRoadBetweenBlackBars) {
  synth::SyntheticPair pair = test::named_pair("street");
  const int width = pair.left.width, height = pair.left.height;
  const std::size_t channels = pair.left.bytes.size() / static_cast<std::size_t>(width * height);
  for (Frame* const view : {&pair.left, &pair.right}) {
    for (int v = 0; v < height; ++v) {
      const auto row = view->bytes.begin() + static_cast<std::ptrdiff_t>(v * width) * std::ptrdiff_t(channels);
      const auto bar = static_cast<std::ptrdiff_t>(width / 5) * std::ptrdiff_t(channels);
      std::fill(row, row + bar, std::uint8_t{0});
      std::fill(row + std::ptrdiff_t(channels) * width - bar, row + std::ptrdiff_t(channels) * width, std::uint8_t{0});
    }
  }
  PipelineOptions options = preset("default");
  options.engine = "cpu";
  Image<std::uint8_t> mask(width, height, 0);
  for (int v = 0; v < height; ++v) {
    std::fill_n(mask.row(v), width / 5, std::uint8_t{255});
    std::fill_n(mask.row(v) + width - width / 5, width / 5, std::uint8_t{255});
  }
  Pipeline pipeline(options, pair.calibration), masked(options, pair.calibration);
  masked.set_mask(mask);
  const RoadModelEstimate& road = pipeline.process(pair.left.view(), pair.right.view()).road;
  ASSERT_EQ(road.status, RoadStatus::found) << road.reason;
  EXPECT_NEAR(road.evidence, masked.process(pair.left.view(), pair.right.view()).road.evidence, 0.01);
  for (const int v : {height - 1, 2 * height / 3}) {
    EXPECT_NEAR(road.model.disparity(width / 2, v), pair.plane.disparity(width / 2, v), 0.5);
  }
}

TEST(PipelineMask, WithoutSetPixelsIsNone) {
  const synth::SyntheticPair pair = test::named_pair("demo");
  const int width = pair.left.width, height = pair.left.height;
  PipelineOptions options = preset("fast");
  options.engine = "cpu";
  Pipeline pipeline(options);
  pipeline.set_mask(lower_third(width, height));
  pipeline.set_mask(Image<std::uint8_t>(width, height, 0));
  EXPECT_TRUE(pipeline.process(pair.left.view(), pair.right.view()).mask.empty());
}

TEST(PipelineMask, OfAnotherSizeIsRejected) {
  const synth::SyntheticPair pair = test::named_pair("demo");
  PipelineOptions options = preset("fast");
  options.engine = "cpu";
  Pipeline pipeline(options);
  pipeline.set_mask(lower_third(300, 200));
  try {
    pipeline.process(pair.left.view(), pair.right.view());
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the mask has 300×200 pixels; it must have 960×540 like the pair");
  }
}

}  // namespace
}  // namespace roadstereo

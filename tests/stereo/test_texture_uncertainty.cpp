// What the gradients of a block say about its disparity, against the closed form of its standard error.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "stereo/coarse/texture_uncertainty.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr TextureUncertaintyOptions options{
    .block_radius = 3, .noise = 2.0, .row_offset_sigma_px = 0.4, .half_weight_sigma_px = 0.25};
constexpr int width = 60, height = 40;
constexpr int block_pixels = 49;

/// `grey` in 8-bit levels.
GreyImage paint(const std::function<double(int, int)>& grey) {
  GreyImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image(u, v) = static_cast<std::int16_t>(std::lround(grey(u, v) * grey_scale));
  }
  return image;
}

/// The ignorance of all blocks of row v.
std::vector<float> texture_uncertainty(const GreyImage& image, int v) {
  TextureUncertainty texture;
  texture.start(image, v, options);
  return texture.next();
}

/// s² / (s² + half_at²) for a block with the sums Σ gu² and Σ gu gv.
double closed_form(double squares, double products) {
  const double tilt = products / squares;
  const double s2 =
      options.noise * options.noise / squares + options.row_offset_sigma_px * options.row_offset_sigma_px * tilt * tilt;
  return s2 / (s2 + options.half_weight_sigma_px * options.half_weight_sigma_px);
}

TEST(TextureUncertainty, FlatImageHasNone) {
  const GreyImage flat(width, height, 1600);
  for (const int v : {0, 20, height - 1}) {
    for (const float uncertainty : texture_uncertainty(flat, v)) EXPECT_NEAR(uncertainty, 1, 0.002);
  }
}

TEST(TextureUncertainty, RampIsLimitedByNoiseAlone) {
  for (const double slope : {0.5, 1.0, 3.0}) {
    const GreyImage ramp = paint([&](int u, int) { return slope * u; });
    const auto uncertainty = texture_uncertainty(ramp, 20);
    for (std::size_t u = 4; u + 4 < width; ++u) {
      ASSERT_NEAR(uncertainty[u], closed_form(block_pixels * slope * slope, 0), 1e-5);
    }
  }
}

TEST(TextureUncertainty, VerticalEdgeIsFullyInformative) {
  // Gradients of 50 levels per pixel in the two columns beside the edge.
  const GreyImage edge = paint([](int u, int) { return u < 30 ? 50.0 : 150.0; });
  const auto uncertainty = texture_uncertainty(edge, 20);
  EXPECT_NEAR(uncertainty[29], closed_form(2 * 7 * 50.0 * 50.0, 0), 1e-6);
  EXPECT_LT(uncertainty[29], 0.01);
  EXPECT_GT(uncertainty[20], 0.99);
}

TEST(TextureUncertainty, SlantedEdgeAmplifiesRowError) {
  // Grey levels change ten times as fast down as across: an offset of the rows looks like ten of disparity.
  const GreyImage slanted = paint([](int u, int v) { return 0.5 * u + 5.0 * v; });
  const auto uncertainty = texture_uncertainty(slanted, 20);
  const double error = 10 * options.row_offset_sigma_px;
  const double of_rows = error * error / (error * error + options.half_weight_sigma_px * options.half_weight_sigma_px);
  EXPECT_NEAR(uncertainty[30], closed_form(block_pixels * 0.25, block_pixels * 2.5), 1e-5);
  EXPECT_NEAR(uncertainty[30], of_rows, 0.001);
}

TEST(TextureUncertainty, IsIndependentOfFirstRow) {
  const GreyImage image = test::textured_pair(width, height, [](double, double) { return 0; }).reference;
  for (const int first : {0, 1, 13, 36}) {
    TextureUncertainty texture;
    texture.start(image, first, options);
    for (int v = first; v < height; ++v) ASSERT_EQ(texture.next(), texture_uncertainty(image, v)) << first << ", " << v;
  }
}

}  // namespace
}  // namespace roadstereo

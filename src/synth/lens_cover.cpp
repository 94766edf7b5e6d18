#include "synth/lens_cover.hpp"

#include <algorithm>
#include <cmath>

#include "synth/hash.hpp"
#include "synth/noise.hpp"

namespace roadstereo::synth {
namespace {

/// Column of the left image in which the bonnet, taken to be 1.2 m away, has what column u of a view shows.
double left_column(const Scene& scene, int view, double u) {
  constexpr double distance_m = 1.2;
  return u + view * std::min(scene.rig.focal_px * scene.rig.baseline_m / distance_m, scene.rig.width / 3.0);
}

/// Rows of pixels that the bonnet hides in a column of the left image.
double bonnet_rows(const Scene& scene, double column) {
  const double across = 2 * (column + 0.5) / scene.rig.width - 1;
  return scene.degradation.bonnet_share * scene.rig.height * (1 - 0.35 * across * across);
}

void draw_bonnet(const Scene& scene, int view, Image<float>& irradiance) {
  for (int v = 0; v < irradiance.height(); ++v) {
    for (int u = 0; u < irradiance.width(); ++u) {
      const double column = left_column(scene, view, u);
      const double below_edge = v - (scene.rig.height - bonnet_rows(scene, column));
      if (below_edge < 0) continue;
      // Sheet metal that mirrors the sky softly.
      const double shine = gradient_noise(column / 90.0, v / 25.0, scene.road.seed + 91u) / gradient_noise_sigma;
      irradiance(u, v) = static_cast<float>(std::max(20.0, 70 + 18 * shine + 60 * std::exp(-below_edge / 6)));
    }
  }
}

void draw_snow(const Scene& scene, int view, Image<float>& irradiance) {
  constexpr double white = 235;
  const double unit_px = scene.rig.width / 640.0;
  RandomSequence random(mix64(scene.degradation.noise_seed) + static_cast<std::uint64_t>(view));
  for (int i = 0; i < scene.degradation.snowflakes; ++i) {
    const double x = random.uniform(0, scene.rig.width), y = random.uniform(0, scene.rig.height);
    const double radius = unit_px * random.uniform(0.7, 3.5), opacity = random.uniform(0.4, 0.95);
    const int extent = static_cast<int>(std::ceil(radius + 1));
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    for (int v = std::max(0, row - extent); v <= std::min(irradiance.height() - 1, row + extent); ++v) {
      for (int u = std::max(0, column - extent); u <= std::min(irradiance.width() - 1, column + extent); ++u) {
        const double share = opacity * smooth_step((radius - std::hypot(u - x, v - y)) + 0.5);
        irradiance(u, v) += static_cast<float>(share * (white - static_cast<double>(irradiance(u, v))));
      }
    }
  }
}

}  // namespace

bool is_bonnet(const Scene& scene, int view, double u, double v) {
  if (scene.degradation.bonnet_share <= 0) return false;
  return v >= scene.rig.height - bonnet_rows(scene, left_column(scene, view, u));
}

void cover_lens(const Scene& scene, int view, Image<float>& irradiance) {
  if (scene.degradation.bonnet_share > 0) draw_bonnet(scene, view, irradiance);
  draw_snow(scene, view, irradiance);
}

}  // namespace roadstereo::synth

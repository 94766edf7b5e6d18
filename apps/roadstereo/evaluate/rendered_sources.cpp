#include "evaluate/rendered_sources.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {
namespace {

/// `plane`: that of Z = 0.
LabelledFrame render_labelled(const synth::Scene& scene, int threads, Image<double>& truth, DisparityPlane& plane) {
  synth::SyntheticPair rendered = synth::render(scene, threads);
  LabelledFrame frame;
  frame.pair.left = std::move(rendered.left);
  frame.pair.right = std::move(rendered.right);
  frame.pair.calibration = rendered.calibration;
  frame.road = std::move(rendered.visible);
  truth = std::move(rendered.disparity);
  plane = rendered.plane;
  frame.truth.resize(truth.width(), truth.height());
  std::transform(truth.row(0), truth.row(0) + truth.pixels(), frame.truth.row(0),
                 [](double disparity) { return static_cast<float>(disparity); });
  frame.disparities = disparities_of(frame.truth, 0);
  return frame;
}

LabelledFrame render_road(std::uint64_t seed, int threads) {
  Image<double> truth;
  DisparityPlane plane;
  return render_labelled(synth::random_scene(seed, true), threads, truth, plane);
}

/// Height of the parked cars on the left, metres: a kerb down to the street.
constexpr double car_height_m = 1;

synth::Scene draw_street(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  synth::Scene scene = synth::random_scene(seed, true);
  scene.supersampling = 2;
  scene.rig = synth::named_scene("street").rig;
  scene.rig.width = 640;
  scene.rig.height = 8 * static_cast<int>(uniform(24, 45));
  scene.rig.focal_px = uniform(330, 480);
  scene.rig.camera_height_m = uniform(1.3, 1.9) - car_height_m;
  scene.rig.pitch_deg = uniform(0, 8);
  scene.rig.roll_deg = uniform(-3, 3);
  scene.road.camber = 0;
  scene.road.blobs.clear();
  scene.road.cracks.clear();
  scene.road.kerbs = {{-uniform(1.2, 2.5), -car_height_m, 0.02}};
  const double front_m = uniform(1.2, 3.5);
  const int storeys = static_cast<int>(uniform(2, 5));
  for (int i = 0; i < storeys; ++i) scene.road.kerbs.push_back({front_m + 0.03 * i, 1, 0.02});
  scene.road.texture_contrast = uniform(0.3, 1.1);
  if (uniform(0, 1) < 0.4) scene.degradation.noise_grey = uniform(3, 9);
  if (uniform(0, 1) < 0.4) scene.degradation.blur_px = uniform(1, 2.5);
  return scene;
}

LabelledFrame render_street(std::uint64_t seed, int threads) {
  const synth::Scene scene = draw_street(seed);
  Image<double> truth;
  DisparityPlane top;
  LabelledFrame frame = render_labelled(scene, threads, truth, top);
  // The street is parallel to the plane of the rig, a car's height deeper.
  const double share = scene.rig.camera_height_m / (scene.rig.camera_height_m + car_height_m);
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const double street = share * top.disparity(u, v);
      if (!(std::abs(truth(u, v) - street) < 1e-6)) (*frame.road)(u, v) = 0;
    }
  }
  return frame;
}

LabelledFrame render_wide(std::uint64_t seed, int threads) {
  const synth::Scene scene = synth::random_wide_scene(seed);
  synth::SyntheticPair rendered = synth::render(scene, threads);
  const int quality = scene.degradation.jpeg_quality;
  LabelledFrame frame;
  frame.pair.left = quality > 0 ? io::with_jpeg_loss(rendered.left, quality) : std::move(rendered.left);
  frame.pair.right = quality > 0 ? io::with_jpeg_loss(rendered.right, quality) : std::move(rendered.right);
  frame.pair.calibration = rendered.calibration;
  frame.truth.resize(rendered.disparity.width(), rendered.disparity.height());
  std::transform(rendered.disparity.row(0), rendered.disparity.row(0) + rendered.disparity.pixels(), frame.truth.row(0),
                 [](double disparity) { return static_cast<float>(disparity); });
  frame.disparities = disparities_of(frame.truth, 0);
  frame.road = std::move(rendered.road);
  for (std::size_t i = 0; i < frame.road->pixels(); ++i) {
    if (rendered.visible.row(0)[i] == 0) frame.road->row(0)[i] = 0;
  }
  return frame;
}

LabelledSource make_source(const char* name, int count, int threads, LabelledFrame (*render)(std::uint64_t, int)) {
  LabelledSource source{name, {}, [render, threads](std::size_t frame) { return render(frame + 1, threads); }};
  for (int seed = 1; seed <= count; ++seed) source.frames.push_back(fmt::format("seed {}", seed));
  return source;
}

}  // namespace

LabelledSource rendered_roads(int count, int threads) {
  return make_source("own roads", count, threads, render_road);
}

LabelledSource rendered_streets(int count, int threads) {
  return make_source("own streets", count, threads, render_street);
}

LabelledSource rendered_wide_scenes(int count, int threads) {
  return make_source("own wide scenes", count, threads, render_wide);
}

}  // namespace roadstereo::cli

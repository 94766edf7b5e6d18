#include "evaluate/rendered_sources.hpp"

#include <fmt/core.h>

#include <cmath>
#include <random>

#include "evaluate/rendered_pair.hpp"
#include "roadstereo/synth.hpp"
#include "synth/hash.hpp"

namespace roadstereo::cli {
namespace {

/// The road is what both cameras see.
LabelledFrame labelled(const synth::SyntheticPair& rendered) {
  LabelledFrame frame;
  frame.pair = pair_of(rendered);
  frame.truth = exact_map(rendered);
  frame.road = rendered.visible;
  frame.disparities = disparities_of(frame.truth, 0);
  return frame;
}

LabelledFrame render_road(std::uint64_t seed, int threads) {
  return labelled(render_recorded(synth::random_scene(seed, true), threads));
}

/// Height of the parked cars on the left, metres: a kerb down to the street.
constexpr double car_height_m = 1;

synth::Scene draw_street(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double lower, double upper) {
    return lower + (upper - lower) * synth::unit_interval(random());
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
  const synth::SyntheticPair rendered = render_recorded(scene, threads);
  LabelledFrame frame = labelled(rendered);
  // The street is parallel to the plane of the rig, a car's height deeper.
  const double share = scene.rig.camera_height_m / (scene.rig.camera_height_m + car_height_m);
  for (int v = 0; v < frame.truth.height(); ++v) {
    for (int u = 0; u < frame.truth.width(); ++u) {
      const double street = share * rendered.plane.disparity(u, v);
      if (!(std::abs(rendered.disparity(u, v) - street) < 1e-6)) (*frame.road)(u, v) = 0;
    }
  }
  return frame;
}

LabelledFrame render_wide(std::uint64_t seed, int threads) {
  const synth::SyntheticPair rendered = render_recorded(synth::random_wide_scene(seed), threads);
  LabelledFrame frame = labelled(rendered);
  for (std::size_t i = 0; i < frame.road->pixels(); ++i) {
    if (rendered.road.row(0)[i] == 0) frame.road->row(0)[i] = 0;
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

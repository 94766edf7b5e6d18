#include "evaluate/synth_groups.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

/// Change the image size at a constant field of view.
void resize(synth::Scene& scene, int width, int height) {
  scene.rig.focal_px *= static_cast<double>(width) / scene.rig.width;
  scene.rig.width = width;
  scene.rig.height = height;
}

void remove_texture(synth::Scene& scene) {
  scene.road.texture_contrast = 0.12;
  scene.road.lane_marking = false;
}

void blur_by_motion(synth::Scene& scene) {
  scene.degradation.motion_blur_px = 7;
  scene.degradation.motion_blur_angle_deg = 70;
}

}  // namespace

void add_synth_sizes(CLI::App& command, std::string& sizes) {
  command.add_option("--sizes", sizes, "full: ten scenes of 640x360; small: three of 320x180")
      ->type_name("NAME")
      ->check(CLI::IsMember({"full", "small"}))
      ->capture_default_str();
}

const std::vector<SynthGroup>& synth_groups() {
  static const std::vector<SynthGroup> groups{
      {"clean", [](synth::Scene&) {}},
      {"low texture", remove_texture},
      {"noise", [](synth::Scene& scene) { scene.degradation.noise_grey = 6; }},
      {"blur", [](synth::Scene& scene) { scene.degradation.blur_px = 1.5; }},
      {"motion blur", blur_by_motion},
      {"over-exposure", [](synth::Scene& scene) { scene.degradation.exposure = 2.1; }},
      {"JPEG 60", [](synth::Scene&) {}, 60},
      {"row offset", [](synth::Scene& scene) { scene.degradation.row_offset_px = 0.5; }},
  };
  return groups;
}

std::vector<synth::Scene> synth_scenes(bool small) {
  const std::vector<std::string> names = small ? std::vector<std::string>{"uav", "demo"}
                                               : std::vector<std::string>{"uav", "demo", "nadir", "close", "street"};
  const std::uint64_t random_scenes = small ? 1 : 5;
  std::vector<synth::Scene> scenes;
  scenes.reserve(names.size() + random_scenes);
  for (const std::string& name : names) scenes.push_back(synth::named_scene(name));
  for (std::uint64_t seed = 1; seed <= random_scenes; ++seed) scenes.push_back(synth::random_scene(seed));
  for (synth::Scene& scene : scenes) {
    if (small) {
      resize(scene, 320, 180);
    } else {
      resize(scene, 640, 360);
    }
  }
  return scenes;
}

std::string synth_frame(const SynthGroup& group, std::size_t scene) {
  std::string name = group.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return fmt::format("{}_{:02}", name, scene);
}

SynthCase make_synth_case(const SynthGroup& group, synth::Scene scene, int threads) {
  group.degrade(scene);
  synth::SyntheticPair rendered = synth::render(scene, threads);
  SynthCase result;
  result.pair.left = std::move(rendered.left);
  result.pair.right = std::move(rendered.right);
  if (group.jpeg_quality > 0) {
    result.pair.left = io::with_jpeg_loss(result.pair.left, group.jpeg_quality);
    result.pair.right = io::with_jpeg_loss(result.pair.right, group.jpeg_quality);
  }
  result.pair.calibration = rendered.calibration;
  result.visible = std::move(rendered.visible);
  result.truth.resize(rendered.disparity.width(), rendered.disparity.height());
  result.damage.assign(rendered.labels.width(), rendered.labels.height(), 0);
  double max_disparity = 0;
  for (int v = 0; v < result.truth.height(); ++v) {
    for (int u = 0; u < result.truth.width(); ++u) {
      result.truth(u, v) = static_cast<float>(rendered.disparity(u, v));
      if (rendered.labels(u, v) != 0) result.damage(u, v) = result.visible(u, v);
      max_disparity = std::fmax(max_disparity, rendered.disparity(u, v));
    }
  }
  result.disparities = static_cast<int>(std::ceil(max_disparity)) + 1;
  return result;
}

}  // namespace roadstereo::cli

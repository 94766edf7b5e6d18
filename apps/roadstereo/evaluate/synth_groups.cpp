#include "evaluate/synth_groups.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "evaluate/labelled_frame.hpp"
#include "evaluate/rendered_pair.hpp"

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
      {"JPEG 60", [](synth::Scene& scene) { scene.degradation.jpeg_quality = 60; }},
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
  const synth::SyntheticPair rendered = render_recorded(scene, threads);
  SynthCase result{pair_of(rendered), exact_map(rendered), rendered.visible, rendered.visible};
  for (std::size_t i = 0; i < result.damage.pixels(); ++i) {
    if (rendered.labels.row(0)[i] == 0) result.damage.row(0)[i] = 0;
  }
  result.disparities = disparities_of(result.truth, 0);
  return result;
}

}  // namespace roadstereo::cli

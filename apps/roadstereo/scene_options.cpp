#include "scene_options.hpp"

#include <CLI/CLI.hpp>

#include "image_size.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

namespace {

/// Sets the image size; scales the focal length, so that the field of view is kept.
void apply_size(synth::Rig& rig, const std::string& size) {
  const auto [width, height] = parse_image_size("--size", size);
  rig.focal_px *= static_cast<double>(width) / rig.width;
  rig.width = width;
  rig.height = height;
}

template <class Value>
void override_with(const std::optional<Value>& given, Value& value) {
  if (given) value = *given;
}

synth::Scene base_scene(const SceneOptions& options) {
  if (options.name == "random") return synth::random_wide_scene(options.seed.value_or(1));
  if (options.seed && !options.name.empty()) {
    fail("--seed does not go with --scene ", options.name, "; it goes with --scene random or alone");
  }
  if (options.seed) return synth::random_scene(*options.seed, options.degraded);
  return synth::named_scene(options.name.empty() ? "demo" : options.name);
}

void add_rig_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--size", options.size, "Image size; keeps the field of view")->type_name("WxH");
  command.add_option("--height", options.camera_height_m, "Camera height above the road")->type_name("M");
  command.add_option("--pitch", options.pitch_deg, "Optical axis below the horizon; 90: straight down")
      ->type_name("DEG");
  command.add_option("--roll", options.roll_deg, "Rotation about the optical axis")->type_name("DEG");
  command.add_option("--focal", options.focal_px, "Focal length")->type_name("PX");
  command.add_option("--baseline", options.baseline_m, "Distance between the cameras")->type_name("M");
}

void add_degradation_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--noise", options.noise_grey, "Noise, standard deviation in grey levels")->type_name("GREY");
  command.add_option("--blur", options.blur_px, "Gaussian blur, standard deviation")->type_name("PX");
  command.add_option("--gain", options.gain_difference, "Gain of the right image minus 1")->type_name("X");
  command.add_option("--exposure", options.exposure, "Brightness of both images; clips above 1")->type_name("X");
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--scene", options.name, "Named scene, see --list; random: anything; default: demo")
      ->type_name("NAME");
  CLI::Option* seed = command.add_option("--seed", options.seed, "Seed of a random scene")->type_name("N");
  command.add_flag("--degraded", options.degraded, "Add random image degradation")->needs(seed);
  add_rig_options(command, options);
  add_degradation_options(command, options);
}

synth::Scene make_scene(const SceneOptions& options) {
  synth::Scene scene = base_scene(options);
  if (options.size) apply_size(scene.rig, *options.size);
  override_with(options.camera_height_m, scene.rig.camera_height_m);
  override_with(options.pitch_deg, scene.rig.pitch_deg);
  override_with(options.roll_deg, scene.rig.roll_deg);
  override_with(options.focal_px, scene.rig.focal_px);
  override_with(options.baseline_m, scene.rig.baseline_m);
  override_with(options.noise_grey, scene.degradation.noise_grey);
  override_with(options.blur_px, scene.degradation.blur_px);
  override_with(options.gain_difference, scene.degradation.gain_difference);
  override_with(options.exposure, scene.degradation.exposure);
  override_with(options.supersampling, scene.supersampling);
  scene.validate();
  return scene;
}

}  // namespace roadstereo::cli

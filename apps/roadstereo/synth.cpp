#include "roadstereo/synth.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "scene_options.hpp"
#include "synth_files.hpp"

namespace roadstereo::cli {

namespace {

constexpr int most_frames = 1'000'000;

/// The command line of `synth`.
struct Arguments {
  std::string output;
  SceneOptions scene;
  int frames = 1;
  int threads = 0;
  bool list = false;
  bool quiet = false;
};

void list_scenes() {
  for (const std::string& name : synth::scene_names()) fmt::print("{}\n", name);
}

std::string made_text(const Arguments& arguments, const synth::Scene& scene, const io::OutputFolder& folder) {
  const std::string what = arguments.frames == 1 ? "one pair" : fmt::format("{} pairs", arguments.frames);
  return fmt::format("Made {} of scene {} ({}×{}) with truth in {}\n", what, scene.name, scene.rig.width,
                     scene.rig.height, folder.path().string());
}

void make_frames(const Arguments& arguments) {
  if (arguments.output.empty()) fail("synth needs --output DIR (see roadstereo synth --help)");
  if (arguments.frames < 1 || arguments.frames > most_frames) {
    fail("--frames is ", arguments.frames, "; it must be between 1 and ", most_frames);
  }
  const synth::Scene first = make_scene(arguments.scene);
  io::OutputFolder folder(arguments.output);
  folder.add("calibration.yaml", plain_yaml(first.rig.calibration()));
  for (int frame = 0; frame < arguments.frames; ++frame) {
    const synth::Scene scene = frame == 0 ? first : synth::next_frame(first, frame);
    const synth::SyntheticPair pair = synth::render(scene, arguments.threads);
    add_synthetic_pair(scene, pair, {frame, arguments.frames}, folder);
  }
  folder.commit();
  if (!arguments.quiet) fmt::print("{}", made_text(arguments, first, folder));
}

constexpr const char* synth_footer =
    R"(Into the output folder: left.png, right.png, calibration.yaml, truth_disparity.tiff (32-bit float, NaN
above the horizon), truth_visible.png (255 where the right camera sees the point too), truth_labels.png
(16 bit, id of the damage), truth.json (plane, roll, rig, damages). With several frames left/000000.png
and so on.

Examples:
  roadstereo synth --scene demo --output road
  roadstereo synth --seed 7 --degraded --frames 10 --output flight)";

}  // namespace

void add_synth(CLI::App& app) {
  CLI::App* command = app.add_subcommand("synth", "Make stereo pairs of a road with exact truth");
  command->footer(synth_footer);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--output", arguments->output, "Folder for the pairs; made when it is missing")->type_name("DIR");
  add_scene_options(*command, arguments->scene);
  command->add_option("--frames", arguments->frames, "Pairs along the road")->type_name("N")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Worker threads; 0 takes all cores")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--list", arguments->list, "List the named scenes and stop");
  command->add_flag("--quiet", arguments->quiet, "Print nothing on success");
  command->callback([arguments] { arguments->list ? list_scenes() : make_frames(*arguments); });
}

}  // namespace roadstereo::cli

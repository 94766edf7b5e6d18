#include "roadstereo/synth.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration_yaml.hpp"
#include "commands.hpp"
#include "flight_path.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "scene_options.hpp"
#include "synth_files.hpp"

namespace roadstereo::cli {

namespace {

constexpr int max_frames = 1'000'000;
constexpr double min_rate_hz = 0.001;
constexpr double max_rate_hz = 100'000;

/// Command line of `synth`.
struct SynthArguments {
  std::string output;
  SceneOptions scene;
  int frames = 1;
  std::string flight;  ///< empty: slight motion
  double rate_hz = 30;
  int threads = 0;
  bool list = false;
  bool quiet = false;
};

void list_scenes() {
  for (const std::string& name : synth::scene_names()) fmt::print("{}\n", name);
}

std::string made_text(const SynthArguments& arguments, const synth::Scene& scene, const io::OutputFolder& folder) {
  const std::string what = arguments.frames == 1 ? "one pair" : fmt::format("{} pairs", arguments.frames);
  return fmt::format("Rendered {} of scene {} ({}×{}) with ground truth to {}\n", what, scene.name, scene.rig.width,
                     scene.rig.height, folder.path().string());
}

/// Scenes of the frames.
class Frames {
 public:
  Frames(synth::Scene first, const SynthArguments& arguments) : first_(std::move(first)) {
    if (arguments.flight.empty()) return;
    path_ = parse_flight(arguments.flight);
    // Checks all frames first: the path of a flight may hit the ground.
    for (int frame = 0; frame < arguments.frames; ++frame) scene(frame);
  }

  synth::Scene scene(int frame) const {
    if (path_) return synth::flight_frame(first_, *path_, frame);
    return frame == 0 ? first_ : synth::next_frame(first_, frame);
  }

 private:
  synth::Scene first_;
  std::optional<synth::FlightPath> path_;
};

/// The frames of an earlier, longer sequence, or the pair before a sequence, would belong to none. Frames without a
/// truth are of a recording: they stay.
void remove_other_frames(int frames, io::OutputFolder& folder) {
  const std::vector<std::string> pair = synthetic_pair_files({});
  if (frames > 1 && std::filesystem::exists(folder.path() / pair.back())) {
    for (const std::string& name : pair) folder.remove(name);
  }
  const int first = frames > 1 ? frames : 0;
  for (int frame = first; frame < max_frames; ++frame) {
    const std::vector<std::string> names = synthetic_pair_files({frame, max_frames});
    if (!std::filesystem::exists(folder.path() / names.back())) return;
    for (const std::string& name : names) folder.remove(name);
    if (frame > 0) continue;
    for (const char* const name : {"times.txt", "trajectory_kitti.txt"}) folder.remove(name);
  }
}

void make_frames(const SynthArguments& arguments) {
  if (arguments.output.empty()) fail("synth needs --output DIR (see roadstereo synth --help)");
  if (arguments.frames < 1 || arguments.frames > max_frames) {
    fail("--frames is ", arguments.frames, "; it must be between 1 and ", max_frames);
  }
  if (!(arguments.rate_hz >= min_rate_hz && arguments.rate_hz <= max_rate_hz)) {
    fail("--rate is ", arguments.rate_hz, "; it must be between ", min_rate_hz, " and ", max_rate_hz,
         " frames per second");
  }
  const synth::Scene first = make_scene(arguments.scene);
  const Frames frames(first, arguments);
  io::OutputFolder folder(arguments.output);
  folder.add("calibration.yaml", plain_yaml(first.rig.calibration()));
  if (arguments.frames > 1) folder.add("times.txt", frame_times(arguments.frames, arguments.rate_hz));
  const auto count = static_cast<std::size_t>(arguments.frames);
  std::vector<std::array<double, 12>> poses;
  Progress progress = Progress::on_terminal(count, arguments.quiet || count == 1);
  for (int frame = 0; frame < arguments.frames; ++frame) {
    const synth::Scene scene = frames.scene(frame);
    const synth::SyntheticPair pair = synth::render(scene, arguments.threads);
    add_synthetic_pair(scene, pair, {frame, arguments.frames}, folder);
    poses.push_back(scene.rig.camera_to_road());
    progress.frame_done();
  }
  if (arguments.frames > 1) folder.add("trajectory_kitti.txt", true_trajectory(poses));
  progress.end();
  remove_other_frames(arguments.frames, folder);
  folder.commit();
  if (!arguments.quiet) fmt::print("{}", made_text(arguments, first, folder));
}

constexpr const char* synth_footer =
    R"(Writes left.png, right.png, calibration.yaml, truth_disparity.tiff (32-bit float, NaN above the horizon),
truth_visible.png (255: visible in both cameras), truth_labels.png (16 bit, damage ids), truth_road.png (255: carriageway)
and truth.json (plane, roll, rig, damages) to the output folder. With several frames left/000000.png etc., times.txt
(seconds, one line per frame) and trajectory_kitti.txt (true poses, camera to first camera, a 3×4 row per frame).

--scene random draws streets with parked cars and house fronts, hills, kerbs, verges, shade, water, paint in the sun,
snow, a bonnet, and what cameras do: photon noise, defocus, motion, JPEG, bad rectification. --seed N draws one of them;
without --scene it draws a plain road.

Examples:
  roadstereo synth --scene demo --output road
  roadstereo synth --scene random --seed 7 --output street
  roadstereo synth --seed 7 --degraded --frames 10 --output drive
  roadstereo synth --frames 300 --flight roll=6,pitch=4,climb=0.5,jump=150 --output flight)";

}  // namespace

void add_synth(CLI::App& app) {
  CLI::App* command = app.add_subcommand("synth", "Render stereo pairs of a road with exact ground truth");
  command->footer(flight_help() + "\n" + synth_footer);
  const auto arguments = std::make_shared<SynthArguments>();
  command->add_option("--output", arguments->output, "Output folder; created if missing")->type_name("DIR");
  add_scene_options(*command, arguments->scene);
  command->add_option("--frames", arguments->frames, "Number of pairs along the road")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--flight", arguments->flight, "Roll, pitch and climb of the rig; default: slight motion")
      ->type_name("SPEC");
  command->add_option("--rate", arguments->rate_hz, "Frames per second, for times.txt")
      ->type_name("HZ")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--list", arguments->list, "List the named scenes");
  command->add_flag("--quiet", arguments->quiet, "Print nothing on success");
  command->callback([arguments] { arguments->list ? list_scenes() : make_frames(*arguments); });
}

}  // namespace roadstereo::cli

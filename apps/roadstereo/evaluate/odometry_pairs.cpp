#include "evaluate/odometry_pairs.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "flight/rectified_source.hpp"
#include "flight_path.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/trajectory_file.hpp"
#include "roadstereo/synth.hpp"
#include "scene_options.hpp"

namespace roadstereo::cli {
namespace {

PosedPairs rendered_pairs(const OdometryTrialOptions& options) {
  const synth::Scene first = make_scene({.name = options.scene,
                                         .size = options.size,
                                         .noise_grey = options.noise_grey,
                                         .supersampling = options.supersampling});
  const synth::FlightPath path = parse_flight(options.flight);
  for (int i = 0; i < options.frames; ++i) synth::flight_frame(first, path, i);  // throws before anything is rendered
  PosedPairs pairs;
  pairs.calibration = first.rig.calibration();
  pairs.frames = static_cast<std::size_t>(options.frames);
  pairs.next = [first, path, i = 0]() mutable {
    const synth::Scene posed = synth::flight_frame(first, path, i++);
    synth::SyntheticPair pair = synth::render(posed);
    return PosedPair{std::move(pair.left), std::move(pair.right), posed.rig.camera_to_road()};
  };
  return pairs;
}

PosedPairs recorded_pairs(const OdometryTrialOptions& options) {
  const std::filesystem::path folder(options.folder);
  std::vector<Pose> poses;
  for (const FramePose& pose : io::read_trajectory((folder / "poses.txt").string()).frames) {
    if (pose.frame != static_cast<int>(poses.size()))
      fail(options.folder, ": poses.txt has no pose of frame ", poses.size());
    poses.push_back(pose.camera_to_world);
  }
  const std::vector<std::string> calibration =
      options.calibration.empty() ? std::vector{(folder / "calibration.yaml").string()} : options.calibration;
  const auto source = std::make_shared<RectifiedSource>(io::open_source({options.folder}), calibration);
  PosedPairs pairs;
  pairs.frames = poses.size();
  pairs.next = [source, folder, poses, i = std::size_t{0}]() mutable {
    std::optional<io::SourcePair> pair = source->next();
    if (!pair) fail(folder.string(), " has ", i, " pairs and ", poses.size(), " poses");
    if (!pair->error.empty()) fail(pair->name, ": ", pair->error);
    const Pose& pose = poses[i++];
    if (i == poses.size() && source->next()) fail(folder.string(), ": there are more pairs than the ", i, " poses");
    return PosedPair{std::move(pair->left), std::move(pair->right), pose, pair->white_level};
  };
  if (!source->calibration()) fail(calibration.front(), ": the calibration must have the size of the images");
  pairs.calibration = *source->calibration();
  return pairs;
}

}  // namespace

PosedPairs posed_pairs(const OdometryTrialOptions& options) {
  return options.folder.empty() ? rendered_pairs(options) : recorded_pairs(options);
}

}  // namespace roadstereo::cli

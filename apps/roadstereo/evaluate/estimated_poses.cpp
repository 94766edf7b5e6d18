#include "evaluate/estimated_poses.hpp"

#include <optional>
#include <random>

#include "evaluate/scratch_folder.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/loop_search.hpp"

namespace roadstereo::cli {
namespace {

constexpr double frame_s = 0.1, noise_m = 0.1;

PositionFix fix_at(double time_s, const RigidTransform& pose, std::mt19937& random) {
  PositionFix fix;
  fix.time_s = time_s;
  fix.position_m = {pose[3], pose[7], pose[11]};
  fix.horizontal_sd_m = fix.vertical_sd_m = noise_m;
  std::normal_distribution<double> noise(0, noise_m);
  for (double& value : fix.position_m) value += noise(random);
  return fix;
}

}  // namespace

std::vector<RigidTransform> estimated_poses(int frames, const std::function<synth::Scene(int)>& scene_of,
                                            const PipelineOptions& options, std::vector<LoopLink>& loops) {
  const StereoCalibration calibration = scene_of(0).rig.calibration();
  const ScratchFolder folder;
  Pipeline pipeline(options, calibration);
  const OdometryOptions odometry_options{.threads = options.threads};
  Odometry odometry(calibration, odometry_options);
  LoopSearch search(calibration, folder / "keyframes", odometry_options);
  PoseGraphInput input;
  std::mt19937 random(1);
  for (int i = 0; i < frames; ++i) {
    const synth::Scene scene = scene_of(i);
    const synth::SyntheticPair pair = synth::render(scene, options.threads);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    odometry.add(i, result);
    if (odometry.reference() == i) search.add(i, result);
    input.times_s.push_back(frame_s * i);
    input.road_up.emplace_back();
    if (result.roll_found) input.road_up.back() = road_axes(ground_plane(result.geometry.plane, calibration)).z;
    input.fixes.push_back(fix_at(input.times_s.back(), scene.rig.camera_to_road(), random));
  }
  input.trajectory = odometry.trajectory();
  input.links = odometry.links();
  PoseGraphOptions graph;
  graph.max_time_offset_s = 0;  // clock and antenna are the camera's
  graph.time_offset_sd_s = graph.lever_arm_sd_m = 0.001;
  const PoseGraphResult result = close_loops(std::move(input), search, graph);
  if (!result.track) fail("the poses are not placed: ", result.track_unused);
  loops.insert(loops.end(), result.loops.begin(), result.loops.end());
  std::vector<RigidTransform> poses;
  for (const FramePose& pose : result.trajectory.frames) {
    if (pose.piece != 0) fail("the positions do not place frame ", pose.frame);
    poses.push_back(pose.camera_to_world);
  }
  return poses;
}

}  // namespace roadstereo::cli

#include "map/build_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "flight/rectified_source.hpp"
#include "inspect_flight.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/trajectory_file.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

/// A recording with its poses.
struct Pass {
  std::unique_ptr<RectifiedSource> source;
  std::map<std::int64_t, FramePose> poses;  ///< by frame
};

class MapBuilder {
 public:
  MapBuilder(const MapSettings& settings, std::filesystem::path folder, const StopSignals& stop)
      : settings_(settings), folder_(std::move(folder)), stop_(stop), options_(make_options(settings.processing)) {
    built_.damage = options_.damage;
    options_.damage.min_confidence = 0;  // what one frame doubts may be clear in the map
  }

  BuiltMap build() {
    std::vector<Pass> passes = open_passes();
    std::int64_t poses = 0;
    for (const Pass& pass : passes) poses += static_cast<std::int64_t>(pass.poses.size());
    Progress progress(poses / settings_.every, 0, settings_.quiet);
    for (std::size_t k = 0; k < passes.size(); ++k) add_pass(static_cast<int>(k), passes[k], progress);
    progress.end();
    return std::move(built_);
  }

 private:
  std::vector<Pass> open_passes() const {
    const io::SourceOptions source = make_source_options(settings_.source_settings);
    const bool one_each = settings_.trajectory.size() == settings_.source.size();
    std::vector<Pass> passes;
    for (std::size_t k = 0; k < settings_.trajectory.size(); ++k) {
      const std::vector<std::string> names = one_each ? std::vector{settings_.source[k]} : settings_.source;
      Pass pass;
      pass.source = std::make_unique<RectifiedSource>(io::open_source(names, source), settings_.calibration);
      if (pass.source->source().live()) fail(names[0], ": a camera has no trajectory; record it first");
      for (const FramePose& pose : io::read_trajectory(settings_.trajectory[k]).frames) pass.poses[pose.frame] = pose;
      const std::optional<std::int64_t> size = pass.source->source().size();
      if (size && pass.poses.rbegin()->first >= *size) {
        fail(settings_.trajectory[k], ": its last pose is of frame ", pass.poses.rbegin()->first, ", but ", names[0],
             " has ", *size, " frames");
      }
      passes.push_back(std::move(pass));
    }
    return passes;
  }

  void add_pass(int number, Pass& pass, Progress& progress) {
    std::optional<Pipeline> pipeline;
    int piece = -1;
    for (std::int64_t index = 0;; ++index) {
      if (stop_.wait(0)) throw Interrupted{"interrupted; there is no map"};
      std::optional<io::SourcePair> pair = pass.source->next();
      if (!pair) break;
      const auto pose = pass.poses.find(pair->index);
      const bool wanted = pose != pass.poses.end() && index % settings_.every == 0;
      if (!wanted) continue;
      ++built_.frames;
      if (!pair->error.empty()) {
        add_reason(pair->error);
      } else {
        if (!pass.source->calibration()) fail("map needs --calibration");
        if (!pipeline) {
          PipelineOptions options = options_;
          if (!sets_white_level(settings_.processing)) options.white_level = pass.source->white_level();
          pipeline.emplace(options, pass.source->calibration());
        }
        if (pose->second.piece != piece) built_.paths.emplace_back();
        piece = pose->second.piece;
        add_frame(number, *pair, pose->second, *pass.source->calibration(), *pipeline);
      }
      progress.frame_done();
    }
  }

  void add_frame(int number, const io::SourcePair& pair, const FramePose& pose, const StereoCalibration& calibration,
                 Pipeline& pipeline) {
    try {
      const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
      if (!result.roll_found || !result.road.has_road()) return add_reason("there is no road: " + result.road.reason);
      const DisparityPlane& road = result.geometry.plane;
      if (!built_.map) begin_map(road, pose, calibration);
      const RigidTransform camera_to_map = compose(world_to_map_, pose.camera_to_world);
      MapFrame frame{result.disparity, result.sigma, pair.left.view(), pipeline.options().white_level, road,
                     calibration,      camera_to_map};
      built_.map->add(frame);
      ++built_.mapped;
      built_.paths.back().push_back(foot_of(road, calibration, camera_to_map));
      pipeline.find_damage(damage_);
      for (MapDamage& found : locate_damage(damage_, road, calibration, camera_to_map)) {
        built_.sightings.push_back({number, pose.frame, std::move(found)});
      }
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      add_reason(error.what());
    }
  }

  static std::array<double, 2> foot_of(const DisparityPlane& road, const StereoCalibration& calibration,
                                       const RigidTransform& camera_to_map) {
    const RigidTransform map_to_road = compose(camera_to_road(road, calibration), inverse(camera_to_map));
    const RigidTransform road_to_map = inverse(map_to_road);
    return {road_to_map[3], road_to_map[7]};
  }

  /// Sets the map's axes: those of the road under the first camera, or with --crs those of the trajectory, with an
  /// origin at a whole number of metres.
  void begin_map(const DisparityPlane& road, const FramePose& pose, const StereoCalibration& calibration) {
    RoadMapOptions options;
    options.cell_m = settings_.cell_m > 0 ? settings_.cell_m : suggested_cell_m(road, calibration);
    options.threads = options_.threads;
    built_.map.emplace(folder_, options);
    if (settings_.crs.empty()) {
      world_to_map_ = compose(camera_to_road(road, calibration), inverse(pose.camera_to_world));
      return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      built_.origin_m[axis] = std::floor(pose.camera_to_world[4 * axis + 3]);
      world_to_map_[4 * axis + 3] = -built_.origin_m[axis];
    }
  }

  void add_reason(const std::string& reason) {
    if (std::find(built_.reasons.begin(), built_.reasons.end(), reason) == built_.reasons.end())
      built_.reasons.push_back(reason);
  }

  const MapSettings& settings_;
  std::filesystem::path folder_;
  const StopSignals& stop_;
  PipelineOptions options_;
  RigidTransform world_to_map_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  DamageMap damage_;
  BuiltMap built_;
};

}  // namespace

void MapSettings::validate() const {
  if (trajectory.empty()) fail("map needs --trajectory FILE: the pose of every frame, 12 numbers a line");
  const bool fits = trajectory.size() == source.size() || (trajectory.size() == 1 && source.size() == 2);
  if (!fits) {
    fail("map has ", source.size(), " recordings and ", trajectory.size(),
         " trajectories; every recording needs one --trajectory FILE");
  }
  if (!(cell_m == 0 || (cell_m >= 0.0005 && cell_m <= 10))) {
    fail("--cell is ", cell_m, "; it must be between 0.0005 and 10 metres");
  }
  if (every < 1) fail("--every is ", every, "; it must be at least 1");
}

BuiltMap build_map(const MapSettings& settings, const std::filesystem::path& folder, const StopSignals& stop) {
  return MapBuilder(settings, folder, stop).build();
}

}  // namespace roadstereo::cli

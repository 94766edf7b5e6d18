#include "evaluate/map_trials.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <random>
#include <tuple>

#include "evaluate/estimated_poses.hpp"
#include "evaluate/scratch_folder.hpp"
#include "finite_values.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {
namespace {

constexpr int passes = 3;
constexpr double step_m = 0.16;

double uniform_between(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937_64::max());
}

/// Road with a pothole or a bump every 0.8 m, left and right of the path in turn.
synth::Scene random_road(const MapTrialOptions& options, int road) {
  std::mt19937_64 random(options.seed + static_cast<std::uint64_t>(road));
  synth::Scene scene;
  scene.rig.width = 480;
  scene.rig.height = 270;
  scene.rig.focal_px = 350;
  scene.rig.camera_height_m = 2;
  scene.rig.pitch_deg = 75;
  scene.road.camber = uniform_between(random, 0, 0.006);
  scene.road.seed = static_cast<std::uint32_t>(random());
  scene.degradation.noise_grey = 2;
  scene.supersampling = 2;
  const double length = step_m * options.frames;
  for (double y = 0.6; y < length; y += 0.8) {
    synth::Blob blob;
    const bool left = scene.road.blobs.size() % 2 == 0;
    blob.x_m = (left ? -1 : 1) * uniform_between(random, 0.3, 0.5);
    blob.y_m = y;
    blob.radius_m = uniform_between(random, 0.12, 0.28);
    blob.depth_m = uniform_between(random, 0.02, 0.09) * (uniform_between(random, 0, 1) < 0.2 ? -1 : 1);
    blob.wall_share = uniform_between(random, 0.25, 0.6);
    blob.seed = static_cast<std::uint32_t>(random());
    scene.road.blobs.push_back(blob);
  }
  return scene;
}

/// The rig in a frame of a pass: rolling, pitching and climbing; in the second pass beside the first one, in the third
/// one back.
synth::Scene frame_of(const synth::Scene& road, int pass, int frame, int frames) {
  synth::Scene scene = road;
  synth::Rig& rig = scene.rig;
  const double t = frame, phase = 1.3 * pass;
  rig.y_m = -0.2 + step_m * t;
  rig.roll_deg = 3 * std::sin(0.25 * t + phase);
  rig.pitch_deg += 4 * std::sin(0.2 * t + phase);
  rig.camera_height_m += 0.2 * std::sin(0.15 * t + phase);
  if (pass == 1) {
    rig.x_m = 0.12;
    rig.y_m += 0.07;
  }
  if (pass == 2) {
    rig.yaw_deg = 180;
    rig.x_m = -0.1;
    rig.y_m = step_m * (frames - frame) + 0.3;
  }
  scene.degradation.noise_seed = static_cast<std::uint32_t>(1 + frame + 1000 * pass);
  return scene;
}

PassDifference compare(const RoadMap& one, const RoadMap& other) {
  const MapBox box = one.bounds();
  const MapRaster a = one.read(box), b = other.read(box);
  double squares = 0, variances = 0;
  std::size_t cells = 0;
  for (std::size_t k = 0; k < a.height.pixels(); ++k) {
    const double difference = static_cast<double>(a.height.row(0)[k]) - b.height.row(0)[k];
    if (!std::isfinite(difference)) continue;
    squares += difference * difference;
    variances += std::pow(a.sigma.row(0)[k], 2) + std::pow(b.sigma.row(0)[k], 2);
    ++cells;
  }
  const auto n = static_cast<double>(cells);
  return {std::sqrt(squares / n), std::sqrt(variances / n), cells};
}

double median_sigma(const RoadMap& map) {
  return median(finite_values(map.read(map.bounds()).sigma));
}

void push_finite(double value, std::vector<double>& values) {
  if (std::isfinite(value)) values.push_back(value);
}

bool is_of(const MapDamage& found, const synth::DamageTruth& truth) {
  const bool depression = truth.kind != "bump";
  const double distance = std::hypot(found.at_m[0] - truth.x_m, found.at_m[1] - truth.y_m);
  return (found.damage.kind == DamageKind::depression) == depression &&
         distance < std::sqrt(truth.area_m2 / std::numbers::pi);
}

/// Error of the depth in the frame that the inventory of a flight takes: whole, then of the smallest standard error.
double best_frame_error(const std::vector<DamageSighting>& sightings, const synth::DamageTruth& truth) {
  const Damage* best = nullptr;
  const auto rank = [](const Damage& damage) {
    return std::tuple(damage.cut_by_border, damage.metrics->max_depth_m.std_error);
  };
  for (const DamageSighting& sighting : sightings) {
    if (!is_of(sighting.found, truth)) continue;
    if (best == nullptr || rank(sighting.found.damage) < rank(*best)) best = &sighting.found.damage;
  }
  return best == nullptr ? NAN : best->metrics->max_depth_m.value - truth.depth_m;
}

/// One road: its three passes, their maps, and the map of all.
class RoadTrial {
 public:
  RoadTrial(const MapTrialOptions& options, int road, Progress& progress) : scene_(random_road(options, road)) {
    RoadMapOptions map_options;
    map_options.cell_m = 0.005;
    map_options.threads = options.threads;
    for (int pass = 0; pass < passes; ++pass) maps_.emplace_back(folder_ / std::to_string(pass), map_options);
    maps_.emplace_back(folder_ / "all", map_options);
    PipelineOptions pipeline_options = preset(options.preset);
    pipeline_options.threads = options.threads;
    damage_ = pipeline_options.damage;
    if (options.estimated_poses) {
      const auto scene_of = [&](int i) {
        return frame_of(scene_, i / options.frames, i % options.frames, options.frames);
      };
      poses_ = roadstereo::cli::estimated_poses(passes * options.frames, scene_of, pipeline_options, loops_);
    }
    pipeline_options.damage.min_confidence = 0;
    for (int pass = 0; pass < passes; ++pass) {
      Pipeline pipeline(pipeline_options, scene_.rig.calibration());
      for (int frame = 0; frame < options.frames; ++frame) {
        add_frame(pass, frame, options, pipeline);
        progress.frame_done();
      }
    }
  }

  void finish(MapTrials& trials) const {
    trials.forward.push_back(compare(maps_[0], maps_[1]));
    trials.reverse.push_back(compare(maps_[0], maps_[2]));
    const RoadMap& all = maps_.back();
    push_finite(single_sigma_m_, trials.single_sigma_m);
    trials.loops.insert(trials.loops.end(), loops_.begin(), loops_.end());
    push_finite(median_sigma(all), trials.fused_sigma_m);
    trials.frames_without_road += frames_without_road_;
    DamageOptions everything = damage_;
    everything.min_confidence = 0;
    const std::vector<RoadDamageRecord> records =
        join_damage(sightings_, find_map_damage(all, everything), all, damage_);
    for (const synth::DamageTruth& truth : truths_) {
      MapDamageTrial trial;
      trial.truth = truth;
      for (const RoadDamageRecord& record : records) {
        if (!is_of(record.best, truth)) continue;
        if (trial.records++ == 0) trial.record = record;
      }
      trial.best_frame_error_m = best_frame_error(sightings_, truth);
      trials.damages.push_back(std::move(trial));
    }
    trials.false_records += static_cast<int>(std::count_if(records.begin(), records.end(), [&](const auto& record) {
      return std::none_of(truths_.begin(), truths_.end(), [&](const auto& truth) { return is_of(record.best, truth); });
    }));
  }

 private:
  void add_frame(int pass, int frame, const MapTrialOptions& options, Pipeline& pipeline) {
    const synth::Scene scene = frame_of(scene_, pass, frame, options.frames);
    const synth::SyntheticPair pair = synth::render(scene, options.threads);
    truths_ = pair.damages;
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    if (!result.roll_found) {
      ++frames_without_road_;
      return;
    }
    const RigidTransform pose = poses_.empty()
                                    ? RigidTransform(scene.rig.camera_to_road())
                                    : poses_[static_cast<std::size_t>(pass) * static_cast<std::size_t>(options.frames) +
                                             static_cast<std::size_t>(frame)];
    const MapFrame seen{result.disparity, result.sigma, pair.left.view(), 0, result.geometry.plane,
                        pair.calibration, pose};
    maps_[static_cast<std::size_t>(pass)].add(seen);
    maps_.back().add(seen);
    if (pass == 0 && std::isnan(single_sigma_m_)) single_sigma_m_ = median_sigma(maps_.front());
    for (MapDamage& found : locate_damage(pipeline.find_damage(), result.geometry.plane, pair.calibration, pose)) {
      sightings_.push_back({pass, frame, std::move(found)});
    }
  }

  synth::Scene scene_;
  std::vector<RigidTransform> poses_;  ///< estimated, pass after pass; empty: the true ones
  std::vector<LoopLink> loops_;
  ScratchFolder folder_;
  std::vector<RoadMap> maps_;
  DamageOptions damage_;
  std::vector<DamageSighting> sightings_;
  std::vector<synth::DamageTruth> truths_;
  int frames_without_road_ = 0;
  double single_sigma_m_ = NAN;  ///< of the first frame that was mapped
};

double peak_memory_mib() {
  constexpr double kib_per_mib = 1024;
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / kib_per_mib;
}

}  // namespace

void MapTrialOptions::validate() const {
  if (roads < 1 || roads > 1000) fail("--roads is ", roads, "; it must be between 1 and 1000");
  if (frames < 8 || frames > 1000) fail("--frames is ", frames, "; it must be between 8 and 1000");
}

MapTrials run_map_trials(const MapTrialOptions& options) {
  options.validate();
  MapTrials trials;
  Progress progress = Progress::on_terminal(static_cast<std::size_t>(options.roads) *
                                            static_cast<std::size_t>(options.frames) * passes);
  for (int road = 0; road < options.roads; ++road) RoadTrial(options, road, progress).finish(trials);
  progress.end();
  return trials;
}

double map_memory_growth_mib(int frames) {
  constexpr int width = 160, height = 90;
  constexpr double camera_height_m = 2;
  StereoCalibration rig;
  rig.focal_px = 100;
  rig.baseline_m = 0.12;
  rig.cx_px = 0.5 * (width - 1);
  rig.cy_px = 0.5 * (height - 1);
  rig.width = width;
  rig.height = height;
  const double disparity_px = rig.focal_px * rig.baseline_m / camera_height_m;
  const Image<float> disparity(width, height, static_cast<float>(disparity_px)), sigma(width, height, 0.1F);
  const std::vector<std::uint8_t> grey(static_cast<std::size_t>(width) * height, 100);
  ScratchFolder folder;
  RoadMapOptions options;
  options.cell_m = 0.02;
  options.tile_cells = 64;
  options.max_tiles = 64;
  RoadMap map(folder / "tiles", options);
  double before = 0;
  for (int frame = 0; frame < frames; ++frame) {
    if (frame == frames / 5) before = peak_memory_mib();
    const RigidTransform pose{1, 0, 0, 0, 0, -1, 0, 0.5 * frame, 0, 0, -1, camera_height_m};
    map.add({disparity, sigma, FrameView::grey8(grey.data(), width, height), 0, {disparity_px, 0, 0}, rig, pose});
  }
  return peak_memory_mib() - before;
}

}  // namespace roadstereo::cli

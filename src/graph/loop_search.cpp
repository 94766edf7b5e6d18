#include "roadstereo/loop_search.hpp"

#include <algorithm>
#include <cmath>
#include <list>
#include <set>
#include <utility>

#include "core/scratch.hpp"
#include "graph/keyframe_store.hpp"
#include "graph/loop_candidates.hpp"
#include "odometry/link_estimator.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// Loops are rare and decide much: a weak link is none.
OdometryOptions strict(OdometryOptions options) {
  constexpr double min_overlap = 0.25;
  options.validate();
  options.min_correlation = std::max(options.min_correlation, options.weak_correlation);
  options.min_overlap = std::max(options.min_overlap, min_overlap);
  return options;
}

/// A keyframe in memory.
struct Loaded {
  std::size_t index = 0;
  KeyframeMaps maps;
  ImagePyramid pyramid;
  LinkReference reference;
  double disparity_offset_px = 0;

  LinkMaps view() const { return {pyramid, maps.disparity, maps.sigma, disparity_offset_px}; }
};

RigidMotion motion_between(const Trajectory& trajectory, int from, int to) {
  const auto pose = [&](int frame) { return motion_of(pose_of(trajectory, frame).camera_to_world); };
  return orthonormal(inverse(pose(to)) * pose(from));
}

/// Turn about the road's normal of a motion between two frames.
double yaw_of(const RigidMotion& motion, const FrameRoad& from, const FrameRoad& to) {
  const RoadAxes &a = from.axes, &b = to.axes;
  const Vector<3> x = motion.rotated(a.x);
  return std::atan2(dot(x, b.y), dot(x, b.x));
}

}  // namespace

struct LoopSearch::State {
  State(const StereoCalibration& rig, std::filesystem::path folder, const OdometryOptions& wanted)
      : full(rig), store(std::move(folder), rig.disparity_offset_px), options(strict(wanted)) {}

  void add(int frame, const OdometryFrame& maps, double offset_px);
  std::vector<LoopLink> find(const Trajectory& odometry, const Trajectory& best);

  StereoCalibration full;
  KeyframeStore store;
  OdometryOptions options;
  std::vector<KeyframeView> views;
  std::vector<double> offsets_px;
  std::set<std::pair<std::size_t, std::size_t>> tried, found;

 private:
  const Loaded& load(const LinkEstimator& estimator, std::size_t index);
  std::optional<LoopLink> compare(const LinkEstimator& estimator, std::size_t from, std::size_t to,
                                  const Trajectory& best);

  int width_ = 0, height_ = 0;
  std::list<Loaded> recent_;  ///< the most recently used first
};

void LoopSearch::State::add(int frame, const OdometryFrame& maps, double offset_px) {
  if (!views.empty() && frame <= views.back().frame) {
    fail("loop search: frame ", frame, " comes after frame ", views.back().frame, "; indices must grow");
  }
  const int width = maps.grey.width(), height = maps.grey.height();
  if (views.empty()) {
    full.validate(width, height, "loop search");
    width_ = width;
    height_ = height;
  } else if (width != width_ || height != height_) {
    fail("loop search: frame ", frame, " has ", width, "×", height, " pixels, those before it ", width_, "×", height_);
  }
  if (!maps.has_road) return;
  const double u = 0.5 * (width - 1), v = 0.5 * (height - 1), disparity = maps.road.disparity(u, v);
  if (!(disparity + full.disparity_offset_px > 0)) return;
  const std::array<double, 3> centre = full.point_m(u, v, disparity);
  store.write(frame, maps);
  views.push_back({frame, centre, 0.5 * std::min(width, height) * centre[2] / full.focal_px});
  offsets_px.push_back(offset_px);
}

const Loaded& LoopSearch::State::load(const LinkEstimator& estimator, std::size_t index) {
  constexpr std::size_t most = 8;  // about 5 MB each
  const auto known =
      std::find_if(recent_.begin(), recent_.end(), [&](const Loaded& one) { return one.index == index; });
  if (known != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, known);
    return recent_.front();
  }
  if (recent_.size() == most) recent_.pop_back();
  Loaded& loaded = recent_.emplace_front();
  loaded.index = index;
  loaded.maps = store.read(views[index].frame);
  loaded.pyramid.build(loaded.maps.grey);
  loaded.disparity_offset_px = estimator.calibration().disparity_offset_px;
  estimator.select(loaded.view(), loaded.maps.view(), loaded.reference);
  return loaded;
}

std::optional<LoopLink> LoopSearch::State::compare(const LinkEstimator& estimator, std::size_t from, std::size_t to,
                                                   const Trajectory& best) {
  const Loaded& to_frame = load(estimator, to);
  const Loaded& from_frame = load(estimator, from);
  LinkPrior prior;
  prior.motion = motion_between(best, views[from].frame, views[to].frame);
  if (from_frame.reference.road && to_frame.reference.road) {
    prior.yaw_rad = yaw_of(*prior.motion, *from_frame.reference.road, *to_frame.reference.road);
  }
  const double scale = estimator.calibration().focal_px / full.focal_px;
  prior.offset.mean_px = scale * offsets_px[to];
  const std::optional<Alignment> alignment =
      estimator.link(from_frame.reference, to_frame.view(), to_frame.maps.view(), prior);
  if (!alignment) return std::nullopt;
  LoopLink loop;
  loop.link = frame_link(views[from].frame, views[to].frame, *alignment, options);
  loop.centre_m = views[to].centre_m;
  loop.pixel_m = views[to].centre_m[2] / full.focal_px;
  return loop;
}

std::vector<LoopLink> LoopSearch::State::find(const Trajectory& odometry, const Trajectory& best) {
  std::vector<LoopLink> loops;
  if (views.empty()) return loops;
  const LinkEstimator estimator(store.calibration(full), options);
  const LoopPlaces places(views, odometry, best);
  ScratchMemory memory;
  const ScratchScope scratch(memory);
  for (std::size_t to = 0; to < views.size(); ++to) {
    for (const LoopCandidates& visit : places.visits(to)) {
      const auto is_known = [&](std::size_t from) { return found.count({from, to}) > 0; };
      if (std::any_of(visit.begin(), visit.end(), is_known)) continue;
      for (const std::size_t from : visit) {
        if (!tried.insert({from, to}).second) continue;
        std::optional<LoopLink> loop = compare(estimator, from, to, best);
        if (!loop) continue;
        found.insert({from, to});
        loops.push_back(*loop);
        break;
      }
    }
  }
  recent_.clear();
  return loops;
}

LoopSearch::LoopSearch(const StereoCalibration& calibration, std::filesystem::path folder,
                       const OdometryOptions& options)
    : state_(std::make_unique<State>(calibration, std::move(folder), options)) {}
LoopSearch::~LoopSearch() = default;
LoopSearch::LoopSearch(LoopSearch&&) noexcept = default;
LoopSearch& LoopSearch::operator=(LoopSearch&&) noexcept = default;

void LoopSearch::add(int frame, const OdometryFrame& maps, double offset_px) {
  state_->add(frame, maps, offset_px);
}

void LoopSearch::add(int frame, const FrameResult& result, double offset_px) {
  add(frame, {result.grey, result.disparity, result.sigma, result.roll_found, result.geometry.plane}, offset_px);
}

std::size_t LoopSearch::compared() const {
  return state_->tried.size();
}

std::vector<LoopLink> LoopSearch::find(const Trajectory& odometry, const Trajectory& best) {
  return state_->find(odometry, best);
}

PoseGraphResult close_loops(PoseGraphInput input, LoopSearch& search, const PoseGraphOptions& options) {
  constexpr int most_turns = 3;
  PoseGraphResult result = optimise_poses(input, options);
  for (int turn = 0; turn < most_turns; ++turn) {
    const std::vector<LoopLink> loops = search.find(input.trajectory, result.trajectory);
    if (loops.empty()) break;
    input.loops.insert(input.loops.end(), loops.begin(), loops.end());
    result = optimise_poses(input, options);
  }
  return result;
}

}  // namespace roadstereo

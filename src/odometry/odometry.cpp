#include "roadstereo/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/scratch.hpp"
#include "odometry/image_pyramid.hpp"
#include "odometry/link_estimator.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// Frame that later ones are aligned with.
struct Reference {
  FramePose pose;
  LinkReference seen;
};

}  // namespace

void OdometryOptions::validate() const {
  require_range("odometry", "min_correlation", min_correlation, 0.0, 1.0);
  require_range("odometry", "weak_correlation", weak_correlation, min_correlation, 1.0);
  require_range("odometry", "min_overlap", min_overlap, 0.0, 1.0);
  require_range("odometry", "reference_overlap", reference_overlap, 0.0, 1.0);
  require_range("odometry", "kept_frames", kept_frames, 0, std::numeric_limits<int>::max());
  resolve_threads(threads);
}

const char* name_of(LinkStatus status) {
  return status == LinkStatus::good ? "good" : "weak";
}

struct Odometry::State {
  State(const StereoCalibration& rig, const OdometryOptions& wanted) : estimator(rig, wanted) {}

  const FramePose& add(int frame, const OdometryFrame& maps);

  int reference() const { return reference_ ? reference_->pose.frame : -1; }

  LinkEstimator estimator;
  ScratchMemory scratch_memory;
  Trajectory trajectory;
  std::vector<FrameLink> links;

 private:
  void require_valid(int frame, const OdometryFrame& maps) const;
  int steps_to(int frame, double time_s) const;
  RigidMotion predicted(int steps) const;
  std::optional<Alignment> link(const Reference& from, const LinkMaps& maps, const OdometryFrame& frame,
                                const std::optional<RigidMotion>& start) const {
    return estimator.link(from.seen, maps, frame, {start, 0, offset_prior(), usual_correlation_});
  }
  OffsetPrior offset_prior() const;
  void measure_offset(const Alignment& alignment);
  void record(const Reference& from, int frame, const Alignment& alignment);
  void make_reference(const LinkMaps& maps, const OdometryFrame& frame);

  ImagePyramid pyramid_;
  std::optional<Reference> reference_;
  std::optional<Reference> lost_;                             ///< reference of the last piece of more than one frame
  bool is_linked_ = false;                                    ///< whether a frame was linked since the piece began
  std::optional<RigidMotion> velocity_;                       ///< from camera to camera per step
  double time_s_ = std::numeric_limits<double>::quiet_NaN();  ///< of the last frame
  double step_s_ = 0;                                         ///< usual time from frame to frame; 0: unknown
  double offset_px_ = 0;                                      ///< disparity offset at infinity, filtered
  double offset_variance_ = 0.25;                             ///< pixels²; before the first link that of any rig
  bool offset_noticed_ = false;
  double usual_correlation_ = 0;  ///< of the last links
  int width_ = 0, height_ = 0;
  int pieces_ = 0;
};

void Odometry::State::require_valid(int frame, const OdometryFrame& maps) const {
  const int width = maps.grey.width(), height = maps.grey.height();
  const auto same = [&](const auto& map) { return map.width() == width && map.height() == height; };
  if (!same(maps.disparity) || !same(maps.sigma)) fail("odometry: the maps of frame ", frame, " differ in size");
  if (trajectory.frames.empty()) return estimator.calibration().validate(width, height, "odometry");
  if (frame <= trajectory.frames.back().frame) {
    fail("odometry: frame ", frame, " comes after frame ", trajectory.frames.back().frame, "; indices must grow");
  }
  if (width != width_ || height != height_) {
    fail("odometry: frame ", frame, " has ", width, "×", height, " pixels, those before it ", width_, "×", height_);
  }
}

/// What is known of the offset: 0 as long as none was noticed.
OffsetPrior Odometry::State::offset_prior() const {
  if (!offset_noticed_) return {};
  return {offset_px_, std::sqrt(offset_variance_)};
}

/// Forgets all but the last ones, now and then.
template <class List>
void keep_last(std::size_t kept, List& list) {
  if (kept == 0 || list.size() < 2 * kept) return;
  list.erase(list.begin(), list.end() - static_cast<std::ptrdiff_t>(kept));
}

/// Kalman filter of a random walk. An offset is noticed when it is larger than what matching itself may be off by; from
/// then on every link estimates it.
void Odometry::State::measure_offset(const Alignment& alignment) {
  if (!estimator.options().estimate_offset || !(alignment.measured_offset_sd_px > 0)) return;
  constexpr double walk_px = 0.05;   // per frame
  constexpr double spread_px = 0.1;  // of what neighbouring links of a street measure, beyond their standard errors
  constexpr double matching_bias_px = 0.06;  // of what is measured where there is none: sub-pixel bias of matching
  const double variance = alignment.measured_offset_sd_px * alignment.measured_offset_sd_px + spread_px * spread_px;
  offset_variance_ += walk_px * walk_px;
  const double gain = offset_variance_ / (offset_variance_ + variance);
  offset_px_ += gain * (alignment.measured_offset_px - offset_px_);
  offset_variance_ *= 1 - gain;
  if (std::abs(offset_px_) > matching_bias_px) offset_noticed_ = true;
}

void Odometry::State::record(const Reference& from, int frame, const Alignment& alignment) {
  links.push_back(frame_link(from.pose.frame, frame, alignment, estimator.options()));
  FramePose pose;
  pose.frame = frame;
  pose.piece = from.pose.piece;
  pose.camera_to_world = matrix_of(orthonormal(motion_of(from.pose.camera_to_world) * inverse(alignment.motion)));
  pose.covariance = carried(alignment.motion, from.pose.covariance);
  for (std::size_t i = 0; i < pose.covariance.size(); ++i) pose.covariance[i] += links.back().covariance[i];
  trajectory.frames.push_back(pose);
}

void Odometry::State::make_reference(const LinkMaps& maps, const OdometryFrame& frame) {
  if (!reference_) reference_.emplace();
  reference_->pose = trajectory.frames.back();
  estimator.select(maps, frame, reference_->seen);
}

/// Intervals since the last frame: by the indices, or more by the times, where frames are missing without an index.
int Odometry::State::steps_to(int frame, double time_s) const {
  constexpr double most = 20;  // farther ahead nothing is predicted
  const int frames = trajectory.frames.empty() ? 1 : frame - trajectory.frames.back().frame;
  const double by_time = step_s_ > 0 ? std::round((time_s - time_s_) / step_s_) : 0;  // NaN without times
  return by_time > frames && by_time <= most ? static_cast<int>(by_time) : frames;
}

/// Motion from the camera of the reference, by the velocity of the last frames.
RigidMotion Odometry::State::predicted(int steps) const {
  const FramePose& last = trajectory.frames.back();
  RigidMotion motion = inverse(motion_of(last.camera_to_world)) * motion_of(reference_->pose.camera_to_world);
  if (!velocity_) return orthonormal(motion);
  Twist twist = twist_of(*velocity_);
  for (double& value : twist) value *= steps;
  return orthonormal(rigid_motion(twist) * motion);
}

const FramePose& Odometry::State::add(int frame, const OdometryFrame& maps) {
  require_valid(frame, maps);
  const ScratchScope scratch(scratch_memory);
  keep_last(static_cast<std::size_t>(estimator.options().kept_frames), trajectory.frames);
  keep_last(static_cast<std::size_t>(estimator.options().kept_frames), links);
  width_ = maps.grey.width();
  height_ = maps.grey.height();
  pyramid_.build(maps.grey);
  const LinkMaps own{pyramid_, maps.disparity, maps.sigma, estimator.calibration().disparity_offset_px};
  const int steps = steps_to(frame, maps.time_s);
  constexpr double memory = 0.8;
  const double step_s = (maps.time_s - time_s_) / steps;
  constexpr double max_change = 1.5;  // more is a pause, or a frame that is missing
  if (step_s_ > 0 && step_s > 0 && step_s < max_change * step_s_) {
    step_s_ = memory * step_s_ + (1 - memory) * step_s;
  } else if (!(step_s_ > 0)) {
    step_s_ = step_s;
  }
  time_s_ = maps.time_s;
  std::optional<Alignment> alignment;
  bool is_lost = false;
  if (reference_) {
    alignment = link(*reference_, own, maps, predicted(steps));
    if (!alignment && lost_) {
      alignment = link(*lost_, own, maps, std::nullopt);
      is_lost = alignment.has_value();
    }
  }
  if (!alignment) {
    FramePose pose;
    pose.frame = frame;
    pose.piece = pieces_++;
    trajectory.frames.push_back(pose);
    velocity_.reset();
    if (is_linked_ || !lost_) lost_ = std::exchange(reference_, std::nullopt);
    is_linked_ = false;
    make_reference(own, maps);
    return trajectory.frames.back();
  }
  is_linked_ = true;
  measure_offset(*alignment);
  usual_correlation_ = usual_correlation_ > 0 ? memory * usual_correlation_ + (1 - memory) * alignment->correlation
                                              : alignment->correlation;
  if (is_lost) reference_ = std::exchange(lost_, std::nullopt);
  const FramePose before = trajectory.frames.back();
  record(*reference_, frame, *alignment);
  const FramePose& pose = trajectory.frames.back();
  velocity_.reset();
  if (before.piece == pose.piece) {
    Twist twist = twist_of(inverse(motion_of(pose.camera_to_world)) * motion_of(before.camera_to_world));
    for (double& value : twist) value /= steps;
    velocity_ = rigid_motion(twist);
  }
  if (alignment->overlap < estimator.options().reference_overlap) make_reference(own, maps);
  return trajectory.frames.back();
}

Odometry::Odometry(const StereoCalibration& calibration, const OdometryOptions& options) {
  options.validate();
  state_ = std::make_unique<State>(calibration, options);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

const FramePose& Odometry::add(int frame, const OdometryFrame& maps) {
  return state_->add(frame, maps);
}

const FramePose& Odometry::add(int frame, const FrameResult& result, double time_s) {
  return add(frame, {result.grey, result.disparity, result.sigma, result.roll_found, result.geometry.plane, time_s});
}

int Odometry::reference() const {
  return state_->reference();
}

const std::vector<FrameLink>& Odometry::links() const {
  return state_->links;
}

const Trajectory& Odometry::trajectory() const {
  return state_->trajectory;
}

}  // namespace roadstereo

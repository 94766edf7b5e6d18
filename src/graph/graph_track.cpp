#include "graph/graph_track.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "graph/track_alignment.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr double best_noise_m = 0.01;  // of the best receivers

}  // namespace

/// Puts the pieces where the fixes have them.
void GraphTrack::align(PoseGraphResult& result) {
  const std::vector<FramePose>& frames = input_.trajectory.frames;
  if (input_.times_s.size() != frames.size() || input_.road_up.size() != frames.size()) {
    fail("the trajectory has ", frames.size(), " frames, but ", input_.times_s.size(), " times and ",
         input_.road_up.size(), " normals of the road; fixes need one of each per frame");
  }
  anchored_.assign(poses_.size(), 0);
  std::vector<TimedPosition> timed;
  std::vector<Eigen::Vector3d> ups;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto piece = static_cast<std::size_t>(frames[i].piece);
    ups.resize(std::max(ups.size(), piece + 1), Eigen::Vector3d::Zero());
    if (input_.road_up[i]) ups[piece] += poses_[i].rotation * Eigen::Vector3d(input_.road_up[i]->data());
    timed.push_back({piece, input_.times_s[i], poses_[i].position});
  }
  std::vector<std::optional<Eigen::Vector3d>> up(ups.size());
  for (std::size_t i = 0; i < ups.size(); ++i) {
    if (ups[i].norm() > 0) up[i] = ups[i].normalized();
  }
  curve_ = std::make_unique<FixCurve>(input_.fixes, options_.max_fix_gap_s);
  const TrackAlignment alignment = align_to_track(frames_to_align(timed), up, *curve_, options_);
  result.track_unused = alignment.unused;
  result.track_contradicts = alignment.contradicts;
  if (!alignment.unused.empty()) return curve_.reset();
  unknowns_.time_offset_s = aligned_offset_s_ = covered_offset_s_ = alignment.time_offset_s;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const auto& to_earth = alignment.pieces[static_cast<std::size_t>(frames[i].piece)];
    if (!to_earth) continue;
    poses_[i] = *to_earth * poses_[i];
    anchored_[i] = 1;
  }
}

/// Pieces that the fixes place, between their frames.
std::vector<PoseCurve> GraphTrack::anchored_pieces() const {
  std::map<int, std::vector<TimedPose>> pieces;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (anchored_[i] == 0 || !std::isfinite(input_.times_s[i])) continue;
    pieces[input_.trajectory.frames[i].piece].push_back({input_.times_s[i], i, poses_[i]});
  }
  std::vector<PoseCurve> curves;
  curves.reserve(pieces.size());
  for (const auto& [piece, poses] : pieces) curves.emplace_back(poses);
  return curves;
}

/// Positions within the time in which their noise is the same, if there are `steps` of them in `time_s`.
double GraphTrack::shared_by(double steps, double time_s) const {
  return std::max(1.0, std::max(options_.fix_correlation_s, 0.0) * steps / std::max(time_s, 1e-3));
}

void GraphTrack::add_levels(PoseGraphProblem& problem) const {
  constexpr double road_sd_rad = to_radians(3);
  std::size_t roads = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) roads += anchored_[i] != 0 && input_.road_up[i] ? 1U : 0U;
  const double weight = 1 / (road_sd_rad * std::sqrt(static_cast<double>(roads)));
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const auto& up = input_.road_up[i];
    if (anchored_[i] != 0 && up) problem.add_level(i, Eigen::Vector3d(up->data()), weight);
  }
}

/// Of the fixes along the way, or of all if there are none.
void GraphTrack::take_usual_sd() {
  std::vector<double> horizontal, vertical;
  for (const TrackObservation& one : observations_) {
    horizontal.push_back(one.horizontal_sd_m);
    vertical.push_back(one.vertical_sd_m);
  }
  for (std::size_t i = 0; observations_.empty() && i < curve_->fixes().size(); ++i) {
    horizontal.push_back(curve_->fixes()[i].horizontal_sd_m);
    vertical.push_back(curve_->fixes()[i].vertical_sd_m);
  }
  usual_horizontal_m_ = upper_median(horizontal);
  usual_vertical_m_ = upper_median(vertical);
  if (noise_m_ == 0) noise_m_ = usual_horizontal_m_;
}

/// How many times the common error of the fixes one of them has: receivers know when they are worse than usual.
Eigen::Vector3d GraphTrack::shares_of_error(const TrackObservation& one) const {
  const double horizontal = one.horizontal_sd_m / usual_horizontal_m_;
  return {horizontal, horizontal, one.vertical_sd_m / usual_vertical_m_};
}

void GraphTrack::add_to(PoseGraphProblem& problem) {
  constexpr double unknown_altitude_m = 100;  // 0, then: as good as any, so that the height is determined
  pieces_ = anchored_pieces();
  observations_ = observe_track(pieces_, *curve_, unknowns_.time_offset_s, covered_offset_s_, options_.max_fix_gap_s);
  take_usual_sd();
  std::vector<double> fix_times_s;
  for (const PositionFix& fix : curve_->fixes()) fix_times_s.push_back(fix.time_s);
  const double longest_s = std::max(options_.max_fix_gap_s, options_.fix_correlation_s);
  const double of_fixes = shared_by(static_cast<double>(fix_times_s.size()) - 1, recorded_s(fix_times_s, longest_s));
  const double of_frames =
      shared_by(static_cast<double>(poses_.size()), recorded_s(input_.times_s, options_.max_fix_gap_s));
  add_levels(problem);
  const double least_m = std::min(noise_m_, best_noise_m);
  for (const TrackObservation& one : observations_) {
    const Eigen::Vector3d shares = shares_of_error(one);
    const double horizontal = std::max(noise_m_ * shares.x(), least_m);
    const double vertical =
        one.has_z ? vertical_excess_ * one.vertical_sd_m / one.horizontal_sd_m * horizontal : unknown_altitude_m;
    problem.add_fix(one.frame(), {one, {1 / horizontal, 1 / horizontal, 1 / vertical}, shares},
                    one.interpolated ? of_frames : of_fixes);
  }
  const Eigen::Vector3d error_sd(usual_horizontal_m_, usual_horizontal_m_, usual_vertical_m_);
  problem.add_track_prior(error_sd, options_.lever_arm_sd_m, options_.time_offset_sd_s, options_.max_time_offset_s);
  if (!time_offset_found_) problem.hold_time_offset();
  problem.hold_lever_arm(unknown_lever_axes_);
}

/// Axes along which the track does not tell the lever arm twice as well as it was known before: a straight flight has
/// one that looks like a shift.
std::vector<int> GraphTrack::unknown_lever_axes(PoseGraphProblem& solution) const {
  const Eigen::Vector4d deviations = solution.track_deviations();
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (2 * deviations[axis] >= options_.lever_arm_sd_m) axes.push_back(axis);
  }
  return axes;
}

/// Whether the track tells the time offset: at least twice as well as it was known before, and, where the expected
/// one fits, closer than clocks agree that run together, or as one that such clocks are less likely to have (of two
/// normal distributions, with their standard deviation and with that of clocks that do not). An offset at which most of
/// the fixes lie outside of the recording is none: they would be judged by how the camera might have gone on.
bool GraphTrack::finds_time_offset(PoseGraphProblem& solution) const {
  constexpr double together_sd_s = 0.05;
  const double apart_sd_s = std::min(options_.time_offset_sd_s, options_.max_time_offset_s);
  const double sd_s = solution.track_deviations()[3];
  if (2 * sd_s >= apart_sd_s) return false;
  const auto left = std::count_if(observations_.begin(), observations_.end(), [&](const TrackObservation& one) {
    return one.way->covers(one.time_s - unknowns_.time_offset_s, options_.max_fix_gap_s);
  });
  if (2 * static_cast<std::size_t>(left) < observations_.size()) return false;
  if (aligned_offset_s_ != 0 || 2 * sd_s < together_sd_s) return true;
  const auto deviance = [&](double clocks_sd_s) {
    const double variance = clocks_sd_s * clocks_sd_s + sd_s * sd_s;
    return unknowns_.time_offset_s * unknowns_.time_offset_s / variance + std::log(variance);
  };
  return deviance(apart_sd_s) < deviance(together_sd_s);
}

/// The antenna from a position of the track.
Eigen::Vector3d GraphTrack::away(const TrackObservation& one) const {
  const GraphPose& pose = poses_[one.frame()];
  const Eigen::Vector3d antenna =
      one.antenna(pose.position, pose.rotation, unknowns_.lever_arm, unknowns_.time_offset_s);
  const Eigen::Vector3d error = shares_of_error(one).cwiseProduct(unknowns_.fix_error);
  return antenna - one.position_m + error;
}

std::size_t GraphTrack::frames_with_position() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (anchored_[i] != 0 && curve_->segment(input_.times_s[i] + unknowns_.time_offset_s)) ++count;
  }
  return count;
}

/// Standard deviation per axis of a fix with the usual standard error. Of a distance in two dimensions the median
/// is 1.18 of them. As before if no frame has a position.
bool GraphTrack::take_noise(bool always) {
  constexpr double rayleigh_median = 1.1774, normal_median = 0.6745;
  constexpr double settled = 0.8;  // of the noise before
  std::vector<double> horizontal_m, vertical_m;
  for (const TrackObservation& one : observations_) {
    const Eigen::Vector3d usual_m = away(one).cwiseQuotient(shares_of_error(one));
    horizontal_m.push_back(usual_m.head<2>().norm());
    if (one.has_z) vertical_m.push_back(std::abs(usual_m.z()));
  }
  const double after_m =
      horizontal_m.empty() ? noise_m_ : std::max(upper_median(horizontal_m) / rayleigh_median, best_noise_m);
  if (!always && after_m > settled * noise_m_) return false;
  noise_m_ = after_m;
  const double expected_m = noise_m_ * usual_vertical_m_ / usual_horizontal_m_;
  vertical_excess_ = vertical_m.empty() ? 1 : std::max(1.0, upper_median(vertical_m) / normal_median / expected_m);
  return true;
}

bool GraphTrack::hold_unknown(PoseGraphProblem& solution) {
  time_offset_found_ = finds_time_offset(solution);
  if (!time_offset_found_) unknowns_.time_offset_s = aligned_offset_s_;
  unknown_lever_axes_ = unknown_lever_axes(solution);
  for (const int axis : unknown_lever_axes_) unknowns_.lever_arm[axis] = 0;
  const bool same_fixes = unknowns_.time_offset_s == covered_offset_s_;
  covered_offset_s_ = unknowns_.time_offset_s;
  return !time_offset_found_ || !unknown_lever_axes_.empty() || !same_fixes;
}

std::optional<TrackFit> GraphTrack::fit(PoseGraphProblem& solution) const {
  if (observations_.empty()) return std::nullopt;
  TrackFit fit;
  const Eigen::Vector4d deviations = solution.track_deviations();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    fit.lever_arm_m[i] = {unknowns_.lever_arm[axis], deviations[axis]};
  }
  fit.time_offset_s = {unknowns_.time_offset_s, deviations[3]};
  fit.time_offset_found = time_offset_found_;
  double squares = 0;
  for (const TrackObservation& one : observations_) squares += away(one).head<2>().squaredNorm();
  fit.frames = frames_with_position();
  fit.rms_m = std::sqrt(squares / static_cast<double>(observations_.size()));
  return fit;
}

}  // namespace roadstereo

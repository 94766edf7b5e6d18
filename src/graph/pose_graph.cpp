#include "roadstereo/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "graph/pose_graph_problem.hpp"
#include "graph/track_alignment.hpp"
#include "graph/track_observations.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Frames that are linked with each other.
class Components {
 public:
  explicit Components(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0); }
  std::size_t of(std::size_t i) const {
    while (parents_[i] != i) i = parents_[i];
    return i;
  }
  /// The first frame of a component stands for it.
  void join(std::size_t a, std::size_t b) {
    const std::size_t one = of(a), other = of(b);
    parents_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<std::size_t> parents_;
};

class Optimiser {
 public:
  Optimiser(const PoseGraphInput& input, const PoseGraphOptions& options) : input_(input), options_(options) {
    for (const FramePose& frame : input.trajectory.frames) {
      if (!indices_.emplace(frame.frame, poses_.size()).second) fail("frame ", frame.frame, " has two poses");
      poses_.push_back(graph_pose(frame.camera_to_world));
    }
    anchored_.assign(poses_.size(), 0);
    result_.trajectory = input.trajectory;
    result_.loops = input.loops;
  }

  PoseGraphResult run() {
    if (!input_.fixes.empty()) align();
    std::vector<char> taken(result_.loops.size(), 0);
    std::unique_ptr<PoseGraphProblem> problem = solve(taken);
    if (has_track()) {  // with what the fixes prove to be
      constexpr int most_solutions = 4;
      constexpr double settled = 0.8;  // of the noise before; it falls while the time offset is being found
      for (int i = 0; i < most_solutions; ++i) {
        const double after_m = noise_of_fixes();
        if (i > 0 && after_m > settled * noise_m_) break;
        noise_m_ = after_m;
        problem = solve(taken);
      }
      time_offset_found_ = finds_time_offset(*problem);
      if (!time_offset_found_) track_.time_offset_s = aligned_offset_s_;
      unknown_lever_axes_ = unknown_lever_axes(*problem);
      for (const int axis : unknown_lever_axes_) track_.lever_arm[axis] = 0;
      if (!time_offset_found_ || !unknown_lever_axes_.empty()) problem = solve(taken);
    }
    if (!taken.empty()) {
      taken = agreeing(*problem);
      for (LoopLink& loop : result_.loops) loop.before_m = misclosure(loop);
      problem = solve(taken);
      for (std::size_t i = 0; i < taken.size(); ++i) {
        result_.loops[i].after_m = misclosure(result_.loops[i]);
        result_.loops[i].used = taken[i] != 0 && fits(result_.loops[i].link);
      }
    }
    fill_trajectory(*problem);
    if (has_track() && !observations_.empty()) fill_track(*problem);
    return std::move(result_);
  }

 private:
  std::size_t index(int frame) const {
    const auto found = indices_.find(frame);
    if (found == indices_.end()) fail("a link has frame ", frame, ", which has no pose");
    return found->second;
  }

  bool has_track() const { return curve_ != nullptr; }

  /// Puts the pieces where the fixes have them.
  void align() {
    const std::vector<FramePose>& frames = input_.trajectory.frames;
    if (input_.times_s.size() != frames.size() || input_.road_up.size() != frames.size()) {
      fail("the trajectory has ", frames.size(), " frames, but ", input_.times_s.size(), " times and ",
           input_.road_up.size(), " normals of the road; fixes need one of each per frame");
    }
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
    result_.track_unused = alignment.unused;
    result_.track_contradicts = alignment.contradicts;
    if (!alignment.unused.empty()) return curve_.reset();
    track_.time_offset_s = aligned_offset_s_ = alignment.time_offset_s;
    noise_m_ = input_.fixes.front().horizontal_sd_m;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const auto& to_earth = alignment.pieces[static_cast<std::size_t>(frames[i].piece)];
      if (!to_earth) continue;
      poses_[i] = *to_earth * poses_[i];
      anchored_[i] = 1;
    }
  }

  /// Solves the graph with the loops that are taken.
  std::unique_ptr<PoseGraphProblem> solve(const std::vector<char>& taken) {
    auto problem = std::make_unique<PoseGraphProblem>(poses_, track_);
    Components components(poses_.size());
    const auto add = [&](const FrameLink& link, bool is_loop) {
      problem->add_link(index(link.from), index(link.to), link, is_loop);
      components.join(index(link.from), index(link.to));
    };
    for (FrameLink link : input_.links) {
      for (double& value : link.covariance) value *= link_variance_factor_;
      add(link, false);
    }
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (taken[i] != 0) add(result_.loops[i].link, true);
    }
    if (has_track()) add_track(*problem);
    std::vector<char> has_anchor(poses_.size(), 0);
    for (std::size_t i = 0; i < poses_.size(); ++i) has_anchor[components.of(i)] |= anchored_[i];
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (components.of(i) == i && has_anchor[i] == 0) problem->hold(i);
    }
    component_.resize(poses_.size());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      component_[i] = has_anchor[components.of(i)] != 0 ? anchor_component : components.of(i);
    }
    problem->solve();
    problem->linearise();
    return problem;
  }

  /// Pieces that the fixes place, between their frames.
  std::vector<PoseCurve> anchored_pieces() const {
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
  double shared_by(double steps, double time_s) const {
    return std::max(1.0, std::max(options_.fix_correlation_s, 0.0) * steps / std::max(time_s, 1e-3));
  }

  void add_levels(PoseGraphProblem& problem) const {
    constexpr double road_sd_rad = to_radians(3);
    std::size_t roads = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) roads += anchored_[i] != 0 && input_.road_up[i] ? 1U : 0U;
    const double weight = 1 / (road_sd_rad * std::sqrt(static_cast<double>(roads)));
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const auto& up = input_.road_up[i];
      if (anchored_[i] != 0 && up) problem.add_level(i, Eigen::Vector3d(up->data()), weight);
    }
  }

  void add_track(PoseGraphProblem& problem) {
    constexpr double unknown_altitude_m = 100;  // 0, then: as good as any, so that the height is determined
    pieces_ = anchored_pieces();
    observations_ = observe_track(pieces_, *curve_, track_.time_offset_s, options_.max_fix_gap_s);
    std::vector<double> fix_times_s;
    for (const PositionFix& fix : curve_->fixes()) fix_times_s.push_back(fix.time_s);
    const double longest_s = std::max(options_.max_fix_gap_s, options_.fix_correlation_s);
    const double of_fixes = shared_by(static_cast<double>(fix_times_s.size()) - 1, recorded_s(fix_times_s, longest_s));
    const double of_frames =
        shared_by(static_cast<double>(poses_.size()), recorded_s(input_.times_s, options_.max_fix_gap_s));
    add_levels(problem);
    Eigen::Vector3d error_sd(INFINITY, INFINITY, INFINITY);
    for (const TrackObservation& one : observations_) {
      const double vertical = one.has_z ? one.vertical_sd_m / one.horizontal_sd_m * noise_m_ : unknown_altitude_m;
      problem.add_fix(one.frame(), {one, {1 / noise_m_, 1 / noise_m_, 1 / vertical}},
                      one.interpolated ? of_frames : of_fixes);
      error_sd = error_sd.cwiseMin(Eigen::Vector3d(one.horizontal_sd_m, one.horizontal_sd_m, one.vertical_sd_m));
    }
    problem.add_track_prior(error_sd, options_.lever_arm_sd_m, options_.time_offset_sd_s, options_.max_time_offset_s);
    if (!time_offset_found_) problem.hold_time_offset();
    problem.hold_lever_arm(unknown_lever_axes_);
  }

  /// Axes along which the track does not tell the lever arm twice as well as it was known before: a straight flight has
  /// one that looks like a shift.
  std::vector<int> unknown_lever_axes(PoseGraphProblem& problem) const {
    const Eigen::Vector4d deviations = problem.track_deviations();
    std::vector<int> axes;
    for (int axis = 0; axis < 3; ++axis) {
      if (2 * deviations[axis] >= options_.lever_arm_sd_m) axes.push_back(axis);
    }
    return axes;
  }

  /// Whether the track tells the time offset: at least twice as well as it was known before, and, where the expected
  /// one fits, closer than clocks agree that run together, or as one that such clocks are less likely to have (of two
  /// normal distributions, with their standard deviation and with that of clocks that do not).
  bool finds_time_offset(PoseGraphProblem& problem) const {
    constexpr double together_sd_s = 0.05;
    const double apart_sd_s = std::min(options_.time_offset_sd_s, options_.max_time_offset_s);
    const double sd_s = problem.track_deviations()[3];
    if (2 * sd_s >= apart_sd_s) return false;
    if (aligned_offset_s_ != 0 || 2 * sd_s < together_sd_s) return true;
    const auto deviance = [&](double clocks_sd_s) {
      const double variance = clocks_sd_s * clocks_sd_s + sd_s * sd_s;
      return track_.time_offset_s * track_.time_offset_s / variance + std::log(variance);
    };
    return deviance(apart_sd_s) < deviance(together_sd_s);
  }

  /// What is left of a link when the graph's motion is undone.
  GraphPose error_of(const FrameLink& link) const {
    const GraphPose motion = inverse(poses_[index(link.to)]) * poses_[index(link.from)];
    return graph_pose(link.motion) * inverse(motion);
  }

  double misclosure(const LoopLink& loop) const {
    const Eigen::Vector3d centre(loop.centre_m.data());
    const GraphPose error = error_of(loop.link);
    return (error.rotation * centre + error.position - centre).norm();
  }

  /// χ² of a link with a covariance.
  double chi_square(const FrameLink& link, const Eigen::Matrix<double, 6, 6>& covariance) const {
    const GraphPose error = error_of(link);
    const Eigen::AngleAxisd turn(error.rotation);
    Eigen::Matrix<double, 6, 1> x;
    x << error.position, turn.angle() * turn.axis();
    return (whitening<6>(covariance) * x).squaredNorm();
  }

  static Eigen::Matrix<double, 6, 6> covariance_of(const FrameLink& link) {
    return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(link.covariance.data());
  }

  /// Loops that agree with the trajectory (χ² test with both covariances), and how many times the variances of links
  /// are too small: errors of neighbouring links are alike, which adds up along the chain.
  std::vector<char> agreeing(const PoseGraphProblem& problem) {
    constexpr double most_factor = 16;           // measured: standard errors of poses up to 3.6 times too small
    constexpr double chi_square_median = 5.348;  // six degrees of freedom
    std::vector<char> taken;
    std::vector<double> chi_squares;
    for (const LoopLink& loop : result_.loops) {
      const std::size_t from = index(loop.link.from), to = index(loop.link.to);
      double value = INFINITY;  // between worlds nothing tells whether a loop is true
      if (component_[from] == component_[to]) {
        value = chi_square(loop.link, covariance_of(loop.link) + problem.relative_covariance(from, to));
      }
      taken.push_back(value < most_factor * chi_square_6_gate ? 1 : 0);
      if (taken.back() != 0) chi_squares.push_back(value);
    }
    if (!chi_squares.empty()) {
      link_variance_factor_ = std::clamp(upper_median(chi_squares) / chi_square_median, 1.0, most_factor);
    }
    return taken;
  }

  bool fits(const FrameLink& link) const { return chi_square(link, covariance_of(link)) < chi_square_6_gate; }

  void fill_trajectory(PoseGraphProblem& problem) {
    std::map<std::size_t, int> pieces;
    const bool on_earth = std::find(component_.begin(), component_.end(), anchor_component) != component_.end();
    if (on_earth) pieces[anchor_component] = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      FramePose& frame = result_.trajectory.frames[i];
      frame.camera_to_world = matrix_of(poses_[i]);
      Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(frame.covariance.data()) = problem.covariance(i);
      frame.piece = pieces.emplace(component_[i], static_cast<int>(pieces.size())).first->second;
    }
  }

  /// Horizontal distances of the antenna from the positions of the track.
  std::vector<double> distances() const {
    std::vector<double> result;
    for (const TrackObservation& one : observations_) {
      const GraphPose& pose = poses_[one.frame()];
      const Eigen::Vector3d antenna = one.antenna(pose.position, pose.rotation, track_.lever_arm, track_.time_offset_s);
      result.push_back((antenna - one.position_m + track_.fix_error).head<2>().norm());
    }
    return result;
  }

  std::size_t frames_with_position() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (anchored_[i] != 0 && curve_->segment(input_.times_s[i] + track_.time_offset_s)) ++count;
    }
    return count;
  }

  /// Standard deviation per axis. Of a distance in two dimensions the median is 1.18 of them. As before if no frame has
  /// a position.
  double noise_of_fixes() const {
    constexpr double rayleigh_median = 1.1774, least_m = 0.01;  // of the best receivers
    if (observations_.empty()) return noise_m_;
    return std::max(upper_median(distances()) / rayleigh_median, least_m);
  }

  void fill_track(PoseGraphProblem& problem) {
    TrackFit fit;
    const Eigen::Vector4d deviations = problem.track_deviations();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      fit.lever_arm_m[i] = {track_.lever_arm[axis], deviations[axis]};
    }
    fit.time_offset_s = {track_.time_offset_s, deviations[3]};
    fit.time_offset_found = time_offset_found_;
    const std::vector<double> distances_m = distances();
    double squares = 0;
    for (const double distance_m : distances_m) squares += distance_m * distance_m;
    fit.frames = frames_with_position();
    fit.rms_m = std::sqrt(squares / static_cast<double>(distances_m.size()));
    result_.track = fit;
  }

  static constexpr std::size_t anchor_component = static_cast<std::size_t>(-1);

  const PoseGraphInput& input_;
  const PoseGraphOptions& options_;
  std::map<int, std::size_t> indices_;  ///< of frames
  std::vector<GraphPose> poses_;
  std::vector<char> anchored_;          ///< whether the fixes place a frame
  std::vector<std::size_t> component_;  ///< of each frame: its first frame, or `anchor_component`
  std::unique_ptr<FixCurve> curve_;     ///< null without fixes
  std::vector<PoseCurve> pieces_;       ///< anchored ones, before the last solution
  std::vector<TrackObservation> observations_;
  TrackUnknowns track_;
  double aligned_offset_s_ = 0;          ///< 0 unless the alignment needs another one
  bool time_offset_found_ = true;        ///< false: held
  std::vector<int> unknown_lever_axes_;  ///< held at 0
  double noise_m_ = 0;                   ///< of the fixes, per axis
  double link_variance_factor_ = 1;
  PoseGraphResult result_;
};

}  // namespace

bool has_pose_graph() {
  return true;
}

PoseGraphResult optimise_poses(const PoseGraphInput& input, const PoseGraphOptions& options) {
  options.validate();
  if (input.trajectory.frames.empty()) return {};
  return Optimiser(input, options).run();
}

}  // namespace roadstereo

#include "roadstereo/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "core/order_statistics.hpp"
#include "graph/graph_track.hpp"
#include "graph/pose_graph_problem.hpp"
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
  Optimiser(const PoseGraphInput& input, const PoseGraphOptions& options)
      : input_(input), track_(input, options, poses_) {
    for (const FramePose& frame : input.trajectory.frames) {
      if (!indices_.emplace(frame.frame, poses_.size()).second) fail("frame ", frame.frame, " has two poses");
      poses_.push_back(graph_pose(frame.camera_to_world));
    }
    result_.trajectory = input.trajectory;
    result_.loops = input.loops;
  }

  PoseGraphResult run() {
    if (!input_.fixes.empty()) track_.align(result_);
    std::vector<char> taken(result_.loops.size(), 0);
    std::unique_ptr<PoseGraphProblem> problem = solve(taken);
    if (track_.is_used()) {  // with what the fixes prove to be
      constexpr int most_solutions = 4;
      for (int i = 0; i < most_solutions && track_.take_noise(i == 0); ++i) problem = solve(taken);
      for (bool again = track_.hold_unknown(*problem); again; again = track_.take_noise(false)) problem = solve(taken);
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
    if (track_.is_used()) result_.track = track_.fit(*problem);
    return std::move(result_);
  }

 private:
  std::size_t index(int frame) const {
    const auto found = indices_.find(frame);
    if (found == indices_.end()) fail("a link has frame ", frame, ", which has no pose");
    return found->second;
  }

  /// Solves the graph with the loops that are taken.
  std::unique_ptr<PoseGraphProblem> solve(const std::vector<char>& taken) {
    auto problem = std::make_unique<PoseGraphProblem>(poses_, track_.unknowns());
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
    if (track_.is_used()) track_.add_to(*problem);
    std::vector<char> has_anchor(poses_.size(), 0);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (track_.anchors(i)) has_anchor[components.of(i)] = 1;
    }
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

  static constexpr std::size_t anchor_component = static_cast<std::size_t>(-1);

  const PoseGraphInput& input_;
  std::map<int, std::size_t> indices_;  ///< of frames
  std::vector<GraphPose> poses_;
  std::vector<std::size_t> component_;  ///< of each frame: its first frame, or `anchor_component`
  GraphTrack track_;
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

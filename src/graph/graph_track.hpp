#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "graph/fix_curve.hpp"
#include "graph/graph_pose.hpp"
#include "graph/pose_curve.hpp"
#include "graph/pose_graph_problem.hpp"
#include "graph/track_observations.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {

/// Fixes of a pose graph: where they put the pieces of its trajectory, and how they fit its poses.
class GraphTrack {
 public:
  /// All three outlive it.
  GraphTrack(const PoseGraphInput& input, const PoseGraphOptions& options, std::vector<GraphPose>& poses)
      : input_(input), options_(options), poses_(poses) {}

  /// Puts the pieces where the fixes have them, or writes down why the fixes cannot be used.
  void align(PoseGraphResult& result);

  /// Whether there are fixes, and they are used.
  bool is_used() const { return curve_ != nullptr; }
  /// Whether the fixes place a frame.
  bool anchors(std::size_t frame) const { return is_used() && anchored_[frame] != 0; }

  TrackUnknowns& unknowns() { return unknowns_; }
  void add_to(PoseGraphProblem& problem);

  /// Takes the noise of the fixes for what their distances from the last solution say, unless that is hardly less than
  /// before and `always` is false: it falls while the time offset is being found. Returns whether it was taken.
  bool take_noise(bool always);

  /// Holds what a solution does not tell from then on, and takes the fixes that there are at its time offset. Returns
  /// whether that makes another solution.
  bool hold_unknown(PoseGraphProblem& solution);

  /// How the fixes fit a solution; nothing if there is none at the times of the frames.
  std::optional<TrackFit> fit(PoseGraphProblem& solution) const;

 private:
  std::vector<PoseCurve> anchored_pieces() const;
  double shared_by(double steps, double time_s) const;
  void add_levels(PoseGraphProblem& problem) const;
  std::vector<int> unknown_lever_axes(PoseGraphProblem& solution) const;
  bool finds_time_offset(PoseGraphProblem& solution) const;
  void take_usual_sd();
  Eigen::Vector3d shares_of_error(const TrackObservation& one) const;
  Eigen::Vector3d away(const TrackObservation& one) const;
  std::size_t frames_with_position() const;

  const PoseGraphInput& input_;
  const PoseGraphOptions& options_;
  std::vector<GraphPose>& poses_;
  std::vector<char> anchored_;       ///< whether the fixes place a frame; empty before `align`
  std::unique_ptr<FixCurve> curve_;  ///< null without fixes
  std::vector<PoseCurve> pieces_;    ///< anchored ones, before the last solution
  std::vector<TrackObservation> observations_;
  TrackUnknowns unknowns_;
  double aligned_offset_s_ = 0;          ///< 0 unless the alignment needs another one
  double covered_offset_s_ = 0;          ///< whose fixes are taken: all solutions have the same, until one is chosen
  bool time_offset_found_ = true;        ///< false: held
  std::vector<int> unknown_lever_axes_;  ///< held at 0
  double usual_horizontal_m_ = 0, usual_vertical_m_ = 0;  ///< medians of the standard errors of the fixes
  double noise_m_ = 0;                                    ///< of a fix with these, per axis; 0: not known yet
  double vertical_excess_ = 1;  ///< how many times larger the noise of altitudes is than their standard errors say
};

}  // namespace roadstereo

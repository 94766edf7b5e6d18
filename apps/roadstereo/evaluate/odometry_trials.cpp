#include "evaluate/odometry_trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>

#include "evaluate/odometry_pairs.hpp"
#include "evaluate/scratch_folder.hpp"
#include "evaluation/peer_odometry.hpp"
#include "evaluation/peer_programs.hpp"
#include "evaluation/peer_rgbd.hpp"
#include "finite_values.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/loop_search.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {
namespace {

Pose pose_of(const Eigen::Isometry3d& motion) {
  Pose pose{};
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(pose.data()) = motion.matrix().topRows<3>();
  return pose;
}

/// RMS displacement of pixels of the later frame, when its points are moved by the error of a link.
double link_error_px(const Eigen::Isometry3d& error, const Image<float>& disparity, const StereoCalibration& rig) {
  constexpr int step = 16;
  double squares = 0;
  int count = 0;
  for (int v = step / 2; v < disparity.height(); v += step) {
    for (int u = step / 2; u < disparity.width(); u += step) {
      const double d = double{disparity(u, v)};
      if (!(d + rig.disparity_offset_px > 0)) continue;
      const std::array<double, 3> point = rig.point_m(u, v, d);
      const Eigen::Vector3d moved = error * Eigen::Vector3d(point[0], point[1], point[2]);
      const double du = rig.focal_px * moved.x() / moved.z() + rig.cx_px - u;
      const double dv = rig.focal_px * moved.y() / moved.z() + rig.cy_px - v;
      squares += du * du + dv * dv;
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : NAN;
}

/// Poses and errors of links of one method.
struct Track {
  std::vector<Pose> poses;
  std::vector<double> errors_px;
  std::vector<double> errors_sd;
  std::vector<double> times_ms;
  std::size_t lost = 0;
};

OdometryTrial trial_of(const std::string& method, const Track& track, const std::vector<Pose>& truth) {
  OdometryTrial trial;
  trial.method = method;
  trial.score = score_trajectory(truth, track.poses);
  trial.link_errors_px = track.errors_px;
  std::erase_if(trial.link_errors_px, [](double error) { return std::isnan(error); });
  trial.link_errors_sd = track.errors_sd;
  trial.lost = track.lost;
  trial.median_ms = track.times_ms.empty() ? 0 : median(track.times_ms);
  return trial;
}

/// RMS of the six whitened errors.
double whitened_rms(const Eigen::Isometry3d& error, const std::array<double, 36>& values) {
  const Eigen::AngleAxisd turn(error.rotation());
  Eigen::Matrix<double, 6, 1> x;
  x << error.translation(), turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data());
  return std::sqrt(x.dot(covariance.ldlt().solve(x)) / 6);
}

/// Adds the pose and the error of the last link of this library.
void add_own(Odometry& odometry, int frame, const FrameResult& result, const std::vector<Pose>& truth,
             const StereoCalibration& rig, Track& track) {
  const std::size_t links = odometry.links().size();
  track.times_ms.push_back(time_ms([&] { odometry.add(frame, result); }));
  track.poses.push_back(odometry.trajectory().frames.back().camera_to_world);
  if (odometry.links().size() == links) {
    track.lost += frame > 0 ? 1 : 0;
    return;
  }
  const FrameLink& link = odometry.links().back();
  const Eigen::Isometry3d from = isometry(truth[static_cast<std::size_t>(link.from)]);
  const Eigen::Isometry3d to = isometry(truth[static_cast<std::size_t>(link.to)]);
  const Eigen::Isometry3d error = isometry(link.motion) * (to.inverse() * from).inverse();
  track.errors_px.push_back(link_error_px(error, result.disparity, rig));
  track.errors_sd.push_back(whitened_rms(error, link.covariance));
}

/// Odometry of others from frame to frame.
struct FramePeer {
  std::string name;
  std::function<std::optional<std::array<double, 12>>(const FrameResult&)> add;
  Track track{};
};

/// The same for a peer; without a motion the camera stands still.
void add_peer(FramePeer& peer, const FrameResult& result, const std::vector<Pose>& truth,
              const StereoCalibration& rig) {
  Track& track = peer.track;
  std::optional<std::array<double, 12>> found;
  track.times_ms.push_back(time_ms([&] { found = peer.add(result); }));
  if (truth.size() == 1) return track.poses.push_back(pose_of(Eigen::Isometry3d::Identity()));
  const Eigen::Isometry3d motion = found ? isometry(*found) : Eigen::Isometry3d::Identity();
  track.lost += found ? 0 : 1;
  track.poses.push_back(pose_of(isometry(track.poses.back()) * motion.inverse()));
  if (!found) return;
  const Eigen::Isometry3d from = isometry(truth[truth.size() - 2]), to = isometry(truth.back());
  track.errors_px.push_back(link_error_px(motion * (to.inverse() * from).inverse(), result.disparity, rig));
}

/// Poses of a program, as a track. Where it has none, the camera stands still. Those whose scale is unknown get that of
/// the truth.
Track track_of(const io::PeerPoses& peer, const std::vector<Pose>& truth, bool scale_known) {
  Track track;
  std::vector<Eigen::Vector3d> from, to;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& found = peer.camera_to_world[i];
    track.lost += found ? 0 : 1;
    track.poses.push_back(found ? *found : i > 0 ? track.poses.back() : pose_of(Eigen::Isometry3d::Identity()));
    if (!found) continue;
    from.emplace_back(isometry(*found).translation());
    to.emplace_back(isometry(truth[i]).translation());
  }
  track.times_ms = {1000 * peer.seconds / static_cast<double>(truth.size())};
  if (scale_known || from.size() < 3) return track;
  Eigen::Matrix3Xd a(3, from.size()), b(3, from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = from[i];
    b.col(static_cast<Eigen::Index>(i)) = to[i];
  }
  const double scale = std::cbrt(Eigen::umeyama(a, b, true).topLeftCorner<3, 3>().determinant());
  for (Pose& pose : track.poses) {
    for (const std::size_t i : {3U, 7U, 11U}) pose[i] *= scale;
  }
  return track;
}

/// The peers that were asked for.
class Peers {
 public:
  Peers(const OdometryTrialOptions& options, const StereoCalibration& rig, const std::filesystem::path& folder)
      : names_(options.peers), rig_(rig) {
    if (asked("flow")) {
      const auto flow = std::make_shared<io::OpticalFlowOdometry>(rig);
      peers_.push_back({"optical flow, PnP", [flow](const FrameResult& r) { return flow->add(r.grey, r.disparity); }});
    }
    if (asked("rgbd") && !io::RgbdOdometry::available()) {
      missing_.emplace_back("rgbd: this build lacks the module rgbd of libopencv-contrib-dev");
    } else if (asked("rgbd")) {
      const auto rgbd = std::make_shared<io::RgbdOdometry>(rig);
      peers_.push_back(
          {"OpenCV RgbdOdometry", [rgbd](const FrameResult& r) { return rgbd->add(r.grey, r.disparity); }});
    }
    if (asked("open3d") || asked("colmap")) frames_.emplace(folder, rig);
  }

  void add(const FrameResult& result, const std::vector<Pose>& truth) {
    for (FramePeer& peer : peers_) add_peer(peer, result, truth, rig_);
    if (frames_) frames_->add(result.grey, result.disparity);
  }

  /// Runs the programs, and adds all trials.
  void finish(const std::vector<Pose>& truth, OdometryTrials& trials) {
    for (const FramePeer& peer : peers_) trials.methods.push_back(trial_of(peer.name, peer.track, truth));
    const auto run = [&](const char* name, const char* title, auto program, bool scale_known) {
      if (!asked(name)) return;
      try {
        trials.methods.push_back(trial_of(title, track_of(program(*frames_), truth, scale_known), truth));
      } catch (const SystemError&) {
        throw;
      } catch (const Error& error) {
        missing_.push_back(std::string(name) + ": " + error.what());
      }
    };
    run("open3d", "Open3D RGB-D", io::run_open3d, true);
    run("colmap", "COLMAP, scale given", io::run_colmap, false);
    trials.missing = missing_;
  }

 private:
  bool asked(const char* name) const { return std::find(names_.begin(), names_.end(), name) != names_.end(); }

  std::vector<std::string> names_;
  StereoCalibration rig_;
  std::vector<FramePeer> peers_;
  std::optional<io::PeerFrames> frames_;
  std::vector<std::string> missing_;
};

/// Errors of the poses against the first one.
std::vector<double> pose_errors_sd(const Trajectory& trajectory, const std::vector<Pose>& truth) {
  std::vector<double> errors;
  const Eigen::Isometry3d first = isometry(trajectory.frames[0].camera_to_world), true_first = isometry(truth[0]);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const FramePose& pose = trajectory.frames[i];
    if (pose.piece != trajectory.frames[0].piece) continue;
    const Eigen::Isometry3d moved = first.inverse() * isometry(pose.camera_to_world);
    errors.push_back(whitened_rms(moved.inverse() * true_first.inverse() * isometry(truth[i]), pose.covariance));
  }
  return errors;
}

/// Closes loops, and adds the trial.
void add_graph(const Odometry& odometry, LoopSearch& search, const std::vector<Pose>& truth, OdometryTrials& trials) {
  PoseGraphInput input;
  input.trajectory = odometry.trajectory();
  input.links = odometry.links();
  trials.graph = close_loops(input, search);
  trials.compared = search.compared();
  Track track;
  track.lost = trials.methods.front().lost;  // of the same links
  for (const FramePose& pose : trials.graph->trajectory.frames) track.poses.push_back(pose.camera_to_world);
  trials.methods.push_back(trial_of("  with loops", track, truth));
  trials.methods.back().pose_errors_sd = pose_errors_sd(trials.graph->trajectory, truth);
}

void summarise_offsets(const std::vector<FrameLink>& links, OdometryTrials& trials) {
  std::vector<double> offsets;
  for (const FrameLink& link : links) {
    if (link.offset_px != 0) offsets.push_back(link.offset_px);
  }
  trials.links = links.size();
  trials.with_offset = offsets.size();
  trials.offset_px = offsets.empty() ? 0 : median(offsets);
}

}  // namespace

void OdometryTrialOptions::validate() const {
  for (const std::string& peer : peers) {
    constexpr std::array names{"flow", "rgbd", "open3d", "colmap"};
    if (std::find(names.begin(), names.end(), peer) == names.end()) {
      fail("--peers has \"", peer, "\"; it must be a comma-separated list of flow, rgbd, open3d and colmap");
    }
  }
  if (frames < 3 || frames > 100000) fail("--frames is ", frames, "; it must be between 3 and 100000");
}

OdometryTrials run_odometry_trials(const OdometryTrialOptions& options) {
  options.validate();
  PosedPairs pairs = posed_pairs(options);
  Pipeline pipeline(with_settings(preset(options.preset), options.methods), pairs.calibration);
  const OdometryOptions odometry_options{.threads = options.methods.threads};
  Odometry odometry(pairs.calibration, odometry_options);
  const ScratchFolder folder;
  Peers peers(options, pairs.calibration, folder / "peers");
  std::optional<LoopSearch> search;
  if (has_pose_graph()) search.emplace(pairs.calibration, folder / "keyframes", odometry_options);
  Track own;
  std::vector<Pose> truth;
  std::vector<double> matching_ms;
  Progress progress = Progress::on_terminal(pairs.frames);
  for (std::size_t i = 0; i < pairs.frames; ++i) {
    const PosedPair pair = pairs.next();
    truth.push_back(pair.pose);
    if (pair.white_level > 0) pipeline.set_white_level(pair.white_level);
    const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
    matching_ms.push_back(result.ms.total);
    add_own(odometry, static_cast<int>(i), result, truth, pairs.calibration, own);
    if (search && odometry.reference() == static_cast<int>(i)) {
      search->add(static_cast<int>(i), result, odometry.links().empty() ? 0 : odometry.links().back().offset_px);
    }
    peers.add(result, truth);
    progress.frame_done();
  }
  OdometryTrials trials;
  trials.methods = {trial_of("roadstereo", own, truth)};
  trials.methods[0].pose_errors_sd = pose_errors_sd(odometry.trajectory(), truth);
  if (search) add_graph(odometry, *search, truth, trials);
  peers.finish(truth, trials);
  trials.matching_ms = median(matching_ms);
  summarise_offsets(odometry.links(), trials);
  return trials;
}

}  // namespace roadstereo::cli

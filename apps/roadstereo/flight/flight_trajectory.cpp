#include "flight/flight_trajectory.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "finite_values.hpp"
#include "flight/disparity_offset.hpp"
#include "flight/exposure_delay.hpp"
#include "flight/rolling_shutter.hpp"
#include "io/csv.hpp"
#include "roadstereo/io/local_axes.hpp"
#include "roadstereo/io/trajectory_file.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::cli {

namespace {

constexpr std::size_t degrees_of_freedom = 6;

/// Square roots of the diagonal of a covariance.
void add_deviations(const std::array<double, 36>& covariance, io::CsvLine& line) {
  for (std::size_t i = 0; i < degrees_of_freedom; ++i) line.add(std::sqrt(covariance[(degrees_of_freedom + 1) * i]));
}

void add_matrix(const std::array<double, 12>& matrix, io::CsvLine& line) {
  for (const double value : matrix) line.add(value);
}

constexpr const char* matrix_names = "r11,r12,r13,x_m,r21,r22,r23,y_m,r31,r32,r33,z_m";
constexpr const char* deviation_names = "sd_x_m,sd_y_m,sd_z_m,sd_rx_rad,sd_ry_rad,sd_rz_rad";

std::string poses_csv(const Trajectory& trajectory, const std::vector<double>& times_s) {
  std::string text = fmt::format("frame,time_s,piece,{},{}\r\n", matrix_names, deviation_names);
  for (std::size_t i = 0; i < trajectory.frames.size(); ++i) {
    const FramePose& pose = trajectory.frames[i];
    io::CsvLine line;
    line.add(pose.frame).add(times_s[i]).add(pose.piece);
    add_matrix(pose.camera_to_world, line);
    add_deviations(pose.covariance, line);
    text += line.end();
  }
  return text;
}

std::string links_csv(const std::vector<FrameLink>& links) {
  std::string text = fmt::format(
      "from,to,status,correlation,overlap,{},{},offset_px,sd_offset_px,rig_offset_px,sd_rig_offset_px,shutter,sd_"
      "shutter\r\n",
      matrix_names, deviation_names);
  for (const FrameLink& link : links) {
    io::CsvLine line;
    line.add(link.from).add(link.to).add(name_of(link.status));
    line.add(link.correlation, 3).add(link.overlap, 3);
    add_matrix(link.motion, line);
    add_deviations(link.covariance, line);
    line.add(link.offset_px, 3).add(link.offset_sd_px, 3);
    line.add(link.rig_offset_px, 3).add(link.rig_offset_sd_px, 3);
    line.add(link.shutter, 4).add(link.shutter_sd, 4);
    text += line.end();
  }
  return text;
}

/// Length of the path, metres; not across pieces.
double path_length(const Trajectory& trajectory) {
  double length = 0;
  for (std::size_t i = 1; i < trajectory.frames.size(); ++i) {
    const FramePose &a = trajectory.frames[i - 1], &b = trajectory.frames[i];
    if (a.piece != b.piece) continue;
    length += std::hypot(b.camera_to_world[3] - a.camera_to_world[3], b.camera_to_world[7] - a.camera_to_world[7],
                         b.camera_to_world[11] - a.camera_to_world[11]);
  }
  return length;
}

std::string loops_csv(const std::vector<LoopLink>& loops) {
  std::string text = fmt::format("from,to,used,correlation,overlap,misclosure_before_m,misclosure_after_m,{},{}\r\n",
                                 matrix_names, deviation_names);
  for (const LoopLink& loop : loops) {
    io::CsvLine line;
    line.add(loop.link.from).add(loop.link.to).add(loop.used ? 1 : 0);
    line.add(loop.link.correlation, 3).add(loop.link.overlap, 3).add(loop.before_m).add(loop.after_m);
    add_matrix(loop.link.motion, line);
    add_deviations(loop.link.covariance, line);
    text += line.end();
  }
  return text;
}

std::string loops_text(const PoseGraphResult& graph) {
  if (graph.loops_used() == 0) return {};
  const PoseGraphResult::Misclosure misclosure = graph.misclosure();
  constexpr double mm = 1000;
  return fmt::format("; {} loops, misclosure {:.1f} mm before, {:.1f} mm ({:.2f} px) after", graph.loops_used(),
                     mm * misclosure.before_m, mm * misclosure.after_m, misclosure.after_px);
}

std::string track_text(const PoseGraphResult& graph) {
  if (!graph.track) return graph.track_unused.empty() ? std::string() : "; track not used: " + graph.track_unused;
  const TrackFit& fit = *graph.track;
  std::string text = fmt::format("; track RMS {:.3f} m, ", fit.rms_m);
  if (fit.time_offset_found) {
    text += fmt::format("times of the frames {:+.3f} ± {:.3f} s", fit.time_offset_s.value, fit.time_offset_s.std_error);
  } else {
    text += fmt::format("clocks cannot be checked by this way, time offset assumed to be {:.3f} ± {:.3g} s",
                        fit.time_offset_s.value, fit.time_offset_s.std_error);
  }
  text += ", antenna at";
  for (const Measurement& axis : fit.lever_arm_m) text += fmt::format(" {:+.2f} ± {:.2f}", axis.value, axis.std_error);
  return text + " m";
}

CameraPlace place_of(const FramePose& pose, const std::optional<RoadAxes>& road, const io::LocalAxes& axes) {
  CameraPlace place{pose.frame, axes.position(pose.camera_to_world), {}};
  if (road) {
    RigidTransform at_foot = pose.camera_to_world;
    const std::array<double, 3> foot = transform_point(pose.camera_to_world, road->origin_m);
    for (std::size_t i = 0; i < foot.size(); ++i) at_foot[4 * i + 3] = foot[i];
    place.foot = axes.position(at_foot);
  }
  return place;
}

}  // namespace

const std::vector<std::string>& trajectory_file_names() {
  static const std::vector<std::string> names{"trajectory_kitti.txt", "trajectory.tum", "trajectory.csv", "links.csv",
                                              "loops.csv"};
  return names;
}

FlightTrajectory::FlightTrajectory(const StereoCalibration& calibration, const std::filesystem::path& keyframes,
                                   int threads)
    : odometry_(calibration, {.threads = threads}), road_odometry_(calibration), calibration_(calibration) {
  if (has_pose_graph()) loops_.emplace(calibration, keyframes, OdometryOptions{.threads = threads});
}

std::optional<io::RosPose> FlightTrajectory::add(const io::FlightFrame& frame, const FrameResult& result) {
  const auto index = static_cast<int>(frame.index);
  const FramePose& pose = odometry_.add(index, result, frame.time_s);
  times_s_.push_back(frame.time_s);
  std::optional<DisparityPlane> road;
  if (result.roll_found) road = result.geometry.plane;
  road_axes_.emplace_back();
  if (road) road_axes_.back() = road_axes(ground_plane(*road, calibration_));
  if (loops_ && odometry_.reference() == index) {
    loops_->add(index, result, odometry_.links().empty() ? 0 : odometry_.links().back().offset_px);
  }
  return road_odometry_.add(pose, road);
}

void FlightTrajectory::optimise(const TrackSettings& track) {
  if (!loops_) return;
  PoseGraphInput input;
  input.trajectory = odometry_.trajectory();
  input.links = odometry_.links();
  input.times_s = times_s_;
  for (const std::optional<RoadAxes>& axes : road_axes_) {
    input.road_up.push_back(axes ? std::optional(axes->z) : std::nullopt);
  }
  std::optional<io::LocalAxes> axes;
  if (!track.file.empty()) {
    double from_s = INFINITY, to_s = -INFINITY;
    for (double& time_s : input.times_s) {
      time_s += track.offset_s;
      if (std::isfinite(time_s)) from_s = std::min(from_s, time_s), to_s = std::max(to_s, time_s);
    }
    axes.emplace(io::read_track(track.file), from_s, to_s);
    input.fixes = axes->fixes();
  }
  PoseGraphOptions options;
  options.time_offset_sd_s = track.offset_sd_s;
  PoseGraphResult graph = close_loops(std::move(input), *loops_, options);
  loops_.reset();
  std::vector<CameraPlace> places;
  for (std::size_t i = 0; graph.track && i < graph.trajectory.frames.size(); ++i) {
    FramePose& pose = graph.trajectory.frames[i];
    if (pose.piece != 0) continue;
    places.push_back(place_of(pose, road_axes_[i], *axes));
    pose.camera_to_world = axes->to_utm(pose.camera_to_world);  // may throw
  }
  graph_ = std::move(graph);
  places_ = std::move(places);
  if (graph_.track) crs_ = axes->crs();
}

const Trajectory& FlightTrajectory::trajectory() const {
  return graph_.trajectory.frames.empty() ? odometry_.trajectory() : graph_.trajectory;
}

std::vector<StagedFile> FlightTrajectory::files() const {
  const Trajectory& poses = trajectory();
  const int piece = crs_.empty() ? io::longest_piece(poses) : 0;
  const std::vector<std::string>& names = trajectory_file_names();
  return {text_file(names[0], io::kitti_trajectory(poses, piece)),
          text_file(names[1], io::tum_trajectory(poses, piece, times_s_)),
          text_file(names[2], poses_csv(poses, times_s_)), text_file(names[3], links_csv(odometry_.links())),
          text_file(names[4], loops_csv(graph_.loops))};
}

std::vector<HealthFinding> FlightTrajectory::findings() const {
  std::map<int, double> times_s;
  for (std::size_t i = 0; i < times_s_.size(); ++i) times_s[odometry_.trajectory().frames[i].frame] = times_s_[i];
  const std::vector<FrameLink>& links = odometry_.links();
  std::vector<HealthFinding> findings;
  const auto shutter = rolling_shutter(links, times_s);
  const auto delay = exposure_delay(links, times_s, calibration_.focal_px);
  const auto offset = disparity_offset(links);
  if (offset) findings.push_back(*offset);
  if (shutter) findings.push_back(*shutter);
  if (delay && !shutter) findings.push_back(*delay);  // a shutter that rolls bends what the delay is measured from
  return findings;
}

std::string FlightTrajectory::summary() const {
  const std::vector<FrameLink>& links = odometry_.links();
  const auto weak =
      std::count_if(links.begin(), links.end(), [](const FrameLink& link) { return link.status == LinkStatus::weak; });
  std::set<int> pieces;
  for (const FramePose& pose : trajectory().frames) pieces.insert(pose.piece);
  std::string text = fmt::format("{:.2f} m in {} piece{}, {} links ({} weak)", path_length(trajectory()), pieces.size(),
                                 pieces.size() == 1 ? "" : "s", links.size(), weak);
  std::vector<double> offsets;
  for (const FrameLink& link : links) {
    if (link.offset_px != 0) offsets.push_back(link.offset_px);
  }
  if (!offsets.empty()) {
    text += fmt::format("; disparities are short by {:.2f} px at infinity (median), undone in {} links",
                        median(offsets), offsets.size());
  }
  text += loops_text(graph_) + track_text(graph_);
  return crs_.empty() ? text : text + "; poses in " + crs_;
}

}  // namespace roadstereo::cli

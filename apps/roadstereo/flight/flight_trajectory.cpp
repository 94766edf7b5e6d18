#include "flight/flight_trajectory.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "finite_values.hpp"
#include "io/csv.hpp"
#include "roadstereo/io/trajectory_file.hpp"

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
  std::string text = fmt::format("frame,time_s,piece,{},{}\n", matrix_names, deviation_names);
  for (std::size_t i = 0; i < trajectory.frames.size(); ++i) {
    const FramePose& pose = trajectory.frames[i];
    io::CsvLine line;
    line.add(std::int64_t{pose.frame}).add(times_s[i]).add(std::int64_t{pose.piece});
    add_matrix(pose.camera_to_world, line);
    add_deviations(pose.covariance, line);
    text += line.end();
  }
  return text;
}

std::string links_csv(const std::vector<FrameLink>& links) {
  std::string text =
      fmt::format("from,to,status,correlation,overlap,{},{},offset_px,sd_offset_px\n", matrix_names, deviation_names);
  for (const FrameLink& link : links) {
    io::CsvLine line;
    line.add(std::int64_t{link.from}).add(std::int64_t{link.to}).add(name_of(link.status));
    line.add(link.correlation, 3).add(link.overlap, 3);
    add_matrix(link.motion, line);
    add_deviations(link.covariance, line);
    line.add(link.offset_px, 3).add(link.offset_sd_px, 3);
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

}  // namespace

const std::vector<std::string>& trajectory_file_names() {
  static const std::vector<std::string> names{"trajectory_kitti.txt", "trajectory.tum", "trajectory.csv", "links.csv"};
  return names;
}

void FlightTrajectory::add(const io::FlightFrame& frame, const FrameResult& result) {
  odometry_.add(static_cast<int>(frame.index), result);
  times_s_.push_back(frame.time_s);
}

std::vector<StagedFile> FlightTrajectory::files() const {
  const Trajectory& trajectory = odometry_.trajectory();
  const int piece = io::longest_piece(trajectory);
  const std::vector<std::string>& names = trajectory_file_names();
  return {text_file(names[0], io::kitti_trajectory(trajectory, piece)),
          text_file(names[1], io::tum_trajectory(trajectory, piece, times_s_)),
          text_file(names[2], poses_csv(trajectory, times_s_)), text_file(names[3], links_csv(odometry_.links()))};
}

std::string FlightTrajectory::summary() const {
  const std::vector<FrameLink>& links = odometry_.links();
  const auto weak =
      std::count_if(links.begin(), links.end(), [](const FrameLink& link) { return link.status == LinkStatus::weak; });
  const std::vector<FramePose>& frames = odometry_.trajectory().frames;
  const std::size_t pieces = frames.size() - links.size();
  std::string text = fmt::format("{:.2f} m in {} piece{}, {} links ({} weak)", path_length(odometry_.trajectory()),
                                 pieces, pieces == 1 ? "" : "s", links.size(), weak);
  std::vector<double> offsets;
  for (const FrameLink& link : links) {
    if (link.offset_px != 0) offsets.push_back(link.offset_px);
  }
  if (!offsets.empty()) {
    text += fmt::format("; disparities are short by {:.2f} px at infinity (median), undone in {} links",
                        median(offsets), offsets.size());
  }
  return text;
}

}  // namespace roadstereo::cli

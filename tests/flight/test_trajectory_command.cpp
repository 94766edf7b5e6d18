// `inspect --trajectory` and `evaluate odometry` from outside, on a short flight.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "roadstereo/io/trajectory_file.hpp"
#include "roadstereo/pose_graph.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class TrajectoryCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made = run("synth --scene uav --size 256x144 --frames 4 --flight default --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
};

using SlowTrajectoryCommand = TrajectoryCommand;

TEST_F(TrajectoryCommand, FilesHaveMotion) {
  const std::string options = "--trajectory";  // flight/calibration.yaml is taken
  const Outcome outcome = run("inspect flight " + options + " --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("in 1 piece, 3 links (0 weak)"), std::string::npos) << outcome.out;
  const Trajectory trajectory = io::read_trajectory((folder_ / "out/trajectory_kitti.txt").string());
  ASSERT_EQ(trajectory.frames.size(), 4U);
  // Frame 3 is 0.3 m further along the road, and 2 mm higher: the flight's raised cosine with a period of 170 frames.
  const auto& pose = trajectory.frames[3].camera_to_world;
  EXPECT_NEAR(std::hypot(pose[3], pose[7], pose[11]), 0.3, 4e-3);  // a quarter of a pixel
  const std::string links = read_text(folder_ / "out/links.csv"), poses = read_text(folder_ / "out/trajectory.csv");
  EXPECT_EQ(std::count(links.begin(), links.end(), '\n'), 4);
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 5);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/trajectory.tum"));
  std::filesystem::remove(folder_ / "flight/calibration.yaml");
  expect_complaint(run("inspect flight --trajectory --output other"), "--trajectory needs --calibration");
  expect_complaint(run("inspect flight/left/000000.png flight/right/000000.png --trajectory --output pair"),
                   "--trajectory is for recordings only");
}

/// Position of a frame of the drive, from its true poses.
std::vector<std::array<double, 3>> true_positions(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::vector<std::array<double, 3>> positions;
  std::array<double, 12> pose{};
  while (std::all_of(pose.begin(), pose.end(), [&text](double& number) { return bool(text >> number); })) {
    positions.push_back({pose[3], pose[7], pose[11]});
  }
  return positions;
}

using TrajectoryRealData = CommandTest;

TEST_F(TrajectoryRealData, DriveIsOnePieceBackwardsAndInStridesOfMetres) {
  const auto data = data_folder("wider/odometry");
  if (!data) GTEST_SKIP() << "SKIPPED: no real data; set ROADSTEREO_DATA to a folder that has wider/odometry";
  const auto positions = true_positions(*data / "poses.txt");
  ASSERT_EQ(positions.size(), 51U);
  struct Order {
    int first, step, count;
  };
  for (const Order order : {Order{29, -1, 30}, Order{0, 3, 9}, Order{20, -3, 7}, Order{0, 5, 6}}) {
    const std::filesystem::path drive = folder_ / "drive";
    for (const char* const view : {"image_0", "image_1"}) {
      std::filesystem::create_directories(drive / view);
      for (int i = 0; i < order.count; ++i) {
        const std::string from = std::to_string(1000000 + order.first + i * order.step).substr(1),
                          to = std::to_string(1000000 + i).substr(1);
        std::filesystem::create_symlink(*data / view / (from + ".png"), drive / view / (to + ".png"));
      }
    }
    std::filesystem::copy_file(*data / "calibration.yaml", drive / "calibration.yaml");
    const Outcome outcome = run("inspect drive --trajectory --output out");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("in 1 piece,"), std::string::npos) << order.step << outcome.out;
    const Trajectory trajectory = io::read_trajectory((folder_ / "out/trajectory_kitti.txt").string());
    ASSERT_EQ(trajectory.frames.size(), static_cast<std::size_t>(order.count));
    const auto& pose = trajectory.frames.back().camera_to_world;
    const auto &first = positions[static_cast<std::size_t>(order.first)],
               &last = positions[static_cast<std::size_t>(order.first + (order.count - 1) * order.step)];
    const double path = std::hypot(last[0] - first[0], last[1] - first[1], last[2] - first[2]);
    EXPECT_NEAR(std::hypot(pose[3], pose[7], pose[11]), path, 0.02 * path) << order.step;
    std::filesystem::remove_all(drive);
    std::filesystem::remove_all(folder_ / "out");
  }
}

TEST_F(TrajectoryCommand, FrameOfOtherSizeIsLeftOut) {
  const Outcome made = run("synth --scene uav --size 192x108 --output small --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (const char* const view : {"left", "right"}) {
    std::filesystem::copy_file(folder_ / "small" / (std::string(view) + ".png"),
                               folder_ / "flight" / view / "000001.png",
                               std::filesystem::copy_options::overwrite_existing);
  }
  const std::string rig = read_text(folder_ / "flight/calibration.yaml");
  std::string any_size;  // a calibration without an image size fits every frame
  std::istringstream lines(rig);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("width", 0) != 0 && line.rfind("height", 0) != 0) any_size += line + "\n";
  }
  for (const std::string& calibration : {rig, any_size}) {
    write("flight/calibration.yaml", calibration);
    const Outcome outcome = run("inspect flight --trajectory --output out");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("no result 000001: "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("in 1 piece, 2 links"), std::string::npos) << outcome.out;
    const nlohmann::json frames = json_file("out/summary.json")["frames"];
    EXPECT_EQ(frames["good"], 3);
  }
}

/// A bend of 5.5 m, and its positions as a receiver on the camera records them: at 48° north on the central meridian of
/// UTM zone 32, with a clock that is 2.5 s ahead.
class TrackOfBend : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made =
        run("synth --scene uav --size 256x144 --frames 12 --flight loop=40,step=0.5,roll=2,pitch=2 --output flight "
            "--quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Trajectory truth = io::read_trajectory((folder_ / "flight/trajectory_kitti.txt").string());
    const std::array<double, 12> to_road = synth::named_scene("uav").rig.camera_to_road();  // of the first frame
    for (const FramePose& frame : truth.frames) {
      const auto& pose = frame.camera_to_world;
      std::array<double, 3> position{};
      for (std::size_t i = 0; i < 3; ++i) {
        const double* const row = to_road.data() + 4 * i;
        position[i] = row[0] * pose[3] + row[1] * pose[7] + row[2] * pose[11] + row[3];
      }
      truth_.push_back(position);
    }
    std::ifstream times(folder_ / "flight/times.txt");
    for (double time_s = 0; times >> time_s;) times_s_.push_back(time_s);
    ASSERT_EQ(times_s_.size(), truth_.size());
  }

  std::string track(double east_sign, double lat_deg = 48) const {
    // Radii of curvature of WGS84: metres per degree along the meridian and the parallel.
    constexpr double a = 6378137, e2 = 0.00669437999014, degree = 3.14159265358979323846 / 180;
    const double sine = std::sin(lat_deg * degree), w = 1 - e2 * sine * sine;
    const double north_m = degree * a * (1 - e2) / std::pow(w, 1.5);
    const double east_m = degree * a / std::sqrt(w) * std::cos(lat_deg * degree);
    std::string text = "time,lat,lon,alt,h_acc,v_acc\n";
    for (std::size_t i = 0; i < times_s_.size(); ++i) {
      char line[160];
      std::snprintf(line, sizeof line, "%.6f,%.10f,%.10f,%.4f,0.05,0.1\n", times_s_[i] + 2.5,
                    lat_deg + truth_[i][1] / north_m, 9 + east_sign * truth_[i][0] / east_m, 300 + truth_[i][2]);
      text += line;
    }
    return text;
  }

  std::vector<std::array<double, 3>> truth_;  ///< positions on the road: right, ahead, up
  std::vector<double> times_s_;
};

TEST_F(TrackOfBend, PlacesTrajectoryOnTheEarthUnlessMirrored) {
  if (!has_pose_graph()) GTEST_SKIP() << "a build without Ceres";
  write("track.csv", track(1));
  const Outcome outcome = run("inspect flight --trajectory --track track.csv --track-offset 2.5 --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("poses in EPSG:32632"), std::string::npos) << outcome.out;
  const Trajectory found = io::read_trajectory((folder_ / "out/trajectory_kitti.txt").string());
  ASSERT_EQ(found.frames.size(), truth_.size());
  // On an arc of constant speed another time is another direction, so that chords tell, and the place roughly.
  constexpr double scale = 0.9996;  // of UTM on the central meridian, which is at 500 km
  const auto& first = found.frames[0].camera_to_world;
  EXPECT_NEAR(first[3], 500000 + truth_[0][0], 3);
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    const auto& pose = found.frames[i].camera_to_world;
    EXPECT_NEAR(std::hypot(pose[3] - first[3], pose[7] - first[7]),
                scale * std::hypot(truth_[i][0] - truth_[0][0], truth_[i][1] - truth_[0][1]), 0.02)
        << i;
    EXPECT_NEAR(pose[11], 300 + truth_[i][2], 0.1) << i;
  }
  EXPECT_EQ(read_text(folder_ / "out/loops.csv").rfind("from,to,used,", 0), 0U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/.keyframes"));
  const auto summary = nlohmann::json::parse(read_text(folder_ / "out/summary.json"));
  EXPECT_EQ(summary["track"]["used"], true);
  EXPECT_LT(summary["track"]["rms_m"], 0.05);
  EXPECT_LT(std::abs(summary["track"]["time_offset_s"].get<double>()), 1) << "that of --track-offset is right";
  EXPECT_NE(outcome.out.find(summary["path"].get<std::string>()), std::string::npos);
  EXPECT_NE(read_text(folder_ / "out/report.html").find("track RMS"), std::string::npos);

  // With synchronised clocks the place is as exact as the fixes.
  ASSERT_EQ(
      run("inspect flight --trajectory --track track.csv --track-offset 2.5 --track-offset-sd 0.001 --output sure")
          .exit_code,
      0);
  const Trajectory sure = io::read_trajectory((folder_ / "sure/trajectory_kitti.txt").string());
  EXPECT_NEAR(sure.frames[0].camera_to_world[3], 500000 + scale * truth_[0][0], 0.05);

  write("track.csv", track(-1));
  expect_complaint(run("inspect flight --trajectory --track track.csv --track-offset 2.5 --output other --quiet"),
                   "only mirrored");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "other/trajectory_kitti.txt"));  // without the track
  const auto other = nlohmann::json::parse(read_text(folder_ / "other/summary.json"));
  EXPECT_EQ(other["track"]["used"], false);
  EXPECT_NE(other["notices"].dump().find("does not use the track"), std::string::npos);
}

TEST_F(TrackOfBend, ReportHasPlacesOfMap) {
  if (!has_pose_graph()) GTEST_SKIP() << "a build without Ceres";
  write("track.csv", track(1));
  const Outcome outcome = run("inspect flight --map --track track.csv --track-offset 2.5 --output out --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json map = json_file("out/map/map.json");
  ASSERT_GE(map["damages"].size(), 1U);
  EXPECT_EQ(map["crs"], "EPSG:32632");
  const std::string report = read_text(folder_ / "out/report.html");
  for (const char* axis : {"x_m", "y_m"}) {
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", map["damages"][0][axis].get<double>());
    EXPECT_NE(report.find(text), std::string::npos) << text;
  }
}

// UTM ends at 84°: there are no poses in it, but all else.
TEST_F(TrackOfBend, FailureOfPoseGraphLeavesInspection) {
  if (!has_pose_graph()) GTEST_SKIP() << "a build without Ceres";
  write("track.csv", track(1, 85.99));
  expect_complaint(run("inspect flight --trajectory --track track.csv --track-offset 2.5 --output out --quiet"),
                   "the trajectory is that of the odometry alone: ");
  for (const char* name : {"damages.csv", "report.html", "flight.gpkg", "trajectory_kitti.txt"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
  }
}

TEST_F(SlowTrajectoryCommand, MapIsThatOfMapCommandAlsoAfterResume) {
  const Outcome outcome = run("inspect flight --map --output out --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json map = json_file("out/map/map.json");
  EXPECT_EQ(map["mapped"], 4);
  ASSERT_GE(map["damages"].size(), 1U);
  const std::string report = read_text(folder_ / "out/report.html");
  EXPECT_NE(report.find("Map of the road"), std::string::npos);
  ASSERT_EQ(run("map flight --trajectory out/trajectory_kitti.txt --output again --quiet").exit_code, 0);

  // As a kill leaves it after two frames.
  std::filesystem::create_directories(folder_ / "cut/flight");
  const std::string journal = read_text(folder_ / "out/flight/journal.jsonl");
  std::size_t end = 0;
  for (int line = 0; line < 3; ++line) end = journal.find('\n', end) + 1;
  write("cut/flight/journal.jsonl", journal.substr(0, end));
  const Outcome resumed = run("inspect flight --map --output cut --resume --quiet");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  for (const char* name : {"orthophoto.tif", "height.tif", "sigma.tif", "relief.tif", "map.json", "map.jpg",
                           "damages.csv", "sightings.csv", "longitudinal.csv"}) {
    const std::string bytes = read_text(folder_ / "out/map" / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_TRUE(bytes == read_text(folder_ / "again" / name)) << name;
    EXPECT_TRUE(bytes == read_text(folder_ / "cut/map" / name)) << name;
  }
  EXPECT_EQ(read_text(folder_ / "cut/links.csv"), read_text(folder_ / "out/links.csv"));
  EXPECT_EQ(json_file("cut/summary.json")["run"]["resumed_at_frame"], 2);
}

}  // namespace
}  // namespace roadstereo

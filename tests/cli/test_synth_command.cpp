// `synth` from outside: pictures, truth and flights.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;
using SynthCommand = RoadCommandTest;

TEST_F(SynthCommand, WritesImagesAndTruth) {
  make_road();
  const std::set<std::string> expected = {
      "left.png",          "right.png",        "calibration.yaml", "truth_disparity.tiff",
      "truth_visible.png", "truth_labels.png", "truth_road.png",   "truth.json"};
  EXPECT_EQ(names_in(folder_ / "road"), expected);
  const auto truth = json_file("road/truth.json");
  EXPECT_TRUE(truth["plane"]["a1"].is_number());
  EXPECT_TRUE(truth["roll_rad"].is_number());
  EXPECT_EQ(truth["rig"]["width"], 320);
  EXPECT_FALSE(truth["damages"].empty());
}

TEST_F(SynthCommand, NumbersFrames) {
  const Outcome outcome = run("synth --seed 5 --degraded --frames 2 --size 160x120 --output flight");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(names_in(folder_ / "flight/left"), (std::set<std::string>{"000000.png", "000001.png"}));
  EXPECT_TRUE(fs::exists(folder_ / "flight/truth_disparity/000001.tiff"));
  EXPECT_NE(read_text(folder_ / "flight/left/000000.png"), read_text(folder_ / "flight/left/000001.png"));
}

TEST_F(SynthCommand, ShorterSequenceReplacesLonger) {
  ASSERT_EQ(run("synth --scene uav --size 64x48 --frames 4 --output road --quiet").exit_code, 0);
  ASSERT_EQ(run("synth --scene uav --size 64x48 --frames 2 --output road --quiet").exit_code, 0);
  for (const char* folder : {"left", "right", "truth", "truth_labels", "truth_disparity"}) {
    EXPECT_EQ(names_in(folder_ / "road" / folder).size(), 2U) << folder;
  }
  ASSERT_EQ(run("synth --scene uav --size 64x48 --output road --quiet").exit_code, 0);
  EXPECT_TRUE(names_in(folder_ / "road/left").empty());
  EXPECT_FALSE(fs::exists(folder_ / "road/times.txt"));
  // A recording is not its own.
  ASSERT_EQ(run("synth --scene uav --size 64x48 --frames 2 --output drive --quiet").exit_code, 0);
  fs::remove_all(folder_ / "drive/truth");
  ASSERT_EQ(run("synth --scene uav --size 64x48 --output drive --quiet").exit_code, 0);
  EXPECT_EQ(names_in(folder_ / "drive/left").size(), 2U);
  EXPECT_TRUE(fs::exists(folder_ / "drive/times.txt"));
}

TEST_F(SynthCommand, SequenceReplacesPair) {
  make_road();
  ASSERT_EQ(run("synth --scene uav --size 64x48 --frames 2 --output road --quiet").exit_code, 0);
  EXPECT_EQ(names_in(folder_ / "road"),
            (std::set<std::string>{"calibration.yaml", "left", "right", "times.txt", "trajectory_kitti.txt", "truth",
                                   "truth_disparity", "truth_labels", "truth_road", "truth_visible"}));
  // A pair without a truth is not its own.
  ASSERT_EQ(run("synth --scene uav --size 64x48 --output drive --quiet").exit_code, 0);
  fs::remove(folder_ / "drive/truth.json");
  ASSERT_EQ(run("synth --scene uav --size 64x48 --frames 2 --output drive --quiet").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "drive/left.png"));
}

TEST_F(SynthCommand, FollowsFlightPath) {
  const Outcome outcome = run(
      "synth --scene flat --frames 3 --size 64x36 --flight roll=8,period=4,climb=0,jump=2,jump_roll=-3,jump_pitch=0 "
      "--rate 20 --output flight");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_text(folder_ / "flight/times.txt"), "0.000000\n0.050000\n0.100000\n");
  const double roll = json_file("flight/truth/000000.json")["rig"]["roll_deg"];
  const double quarter = json_file("flight/truth/000001.json")["rig"]["roll_deg"];
  const double jumped = json_file("flight/truth/000002.json")["rig"]["roll_deg"];
  EXPECT_NEAR(quarter - roll, 8, 1e-9);
  EXPECT_NEAR(jumped - roll, -3, 1e-9);
}

/// A terminal of which both ends are open here.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    grantpt(master_);
    unlockpt(master_);
    slave_ = open(name().c_str(), O_RDWR | O_NOCTTY);
  }
  ~Terminal() {
    close(slave_);
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::string name() const { return ptsname(master_); }
  /// What has been printed on it.
  std::string text() const {
    std::string all, part(1024, ' ');
    for (ssize_t count = 0; (count = read(master_, part.data(), part.size())) > 0;) {
      all.append(part, 0, static_cast<std::size_t>(count));
    }
    return all;
  }

 private:
  int master_;
  int slave_;
};

TEST_F(SynthCommand, ShowsProgressOnTerminalOnly) {
  const std::string synth = "synth --scene flat --frames 3 --size 64x36 --output ";
  EXPECT_EQ(run(synth + "file").err, "");
  const auto on_terminal = [&](const std::string& arguments) {
    const Terminal terminal;
    const std::string command = "cd '" + folder_.string() + "' && '" ROADSTEREO_BINARY "' " + arguments +
                                " >out.txt 2>'" + terminal.name() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return terminal.text();
  };
  const std::string shown = on_terminal(synth + "terminal");
  EXPECT_NE(shown.find("[########################] 3 of 3 frames"), std::string::npos) << shown;
  EXPECT_NE(shown.find("0:00 left"), std::string::npos) << shown;
  EXPECT_EQ(on_terminal(synth + "quiet --quiet"), "");
}

TEST_F(SynthCommand, RejectsBadFlightPath) {
  const std::string synth = "synth --frames 9 --size 64x36 --output flight --flight ";
  expect_complaint(run(synth + "rol=3"), "has no key 'rol'");
  expect_complaint(run(synth + "roll"), "key=value");
  expect_complaint(run(synth + "roll=3,step=fast"), "'fast' is not a value of step");
  expect_complaint(run(synth + "roll=90"), "roll_deg is 90; it must be between 0 and 45");
  expect_complaint(run(synth + "jump=8,jump_climb=-9"), "camera_height_m is -");
  expect_complaint(run(synth + "default --rate 0"), "--rate is 0");
  EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(SynthCommand, IsDeterministic) {
  for (const std::string name : {"one --threads 1", "two --threads 2"}) {
    ASSERT_EQ(run("synth --seed 9 --size 160x120 --output " + name).exit_code, 0);
  }
  const auto names = names_in(folder_ / "one");
  EXPECT_GE(names.size(), 5U);
  ASSERT_EQ(names_in(folder_ / "two"), names);
  for (const std::string& name : names) {
    EXPECT_EQ(read_text(folder_ / "one" / name), read_text(folder_ / "two" / name)) << name;
  }
}

TEST_F(SynthCommand, AppliesOptions) {
  ASSERT_EQ(run("synth --size 160x120 --pitch 90 --roll 3 --height 1.5 --focal 200 --baseline 0.2 --noise 2 "
                "--blur 0.5 "
                "--gain 0.1 --exposure 1.2 --output road")
                .exit_code,
            0);
  const auto truth = json_file("road/truth.json");
  EXPECT_EQ(truth["rig"]["pitch_deg"], 90);
  EXPECT_EQ(truth["rig"]["focal_px"], 200);
  EXPECT_EQ(truth["degradation"]["noise_grey"], 2);
  EXPECT_EQ(truth["degradation"]["exposure"], 1.2);
}

TEST_F(SynthCommand, RejectsBadOptions) {
  expect_complaint(run("synth --scene dmeo --output road"), 2, "demo");
  expect_complaint(run("synth --size 640 --output road"), 2, "640x360");
  expect_complaint(run("synth --frames 0 --output road"), 2, "--frames");
  expect_complaint(run("synth --scene demo --seed 1 --output road"), 2, "--seed");
  expect_complaint(run("synth"), 2, "--output");
  EXPECT_TRUE(names_in(folder_).empty());
}

TEST_F(SynthCommand, ListsScenes) {
  const Outcome outcome = run("synth --list");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("demo\n"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo

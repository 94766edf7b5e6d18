// Whole recordings from the command line: what is written, what goes wrong, and going on after a stop or a kill.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

constexpr int distinct_frames = 4;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The cells of a line of CSV without quotes.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char letter : line) {
    if (letter == ',') {
      cells.emplace_back();
    } else if (letter != '\r') {
      cells.back() += letter;
    }
  }
  return cells;
}

class FlightCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    synth::Scene scene = synth::named_scene("uav");
    scene.rig.focal_px *= 256.0 / scene.rig.width;
    scene.rig.width = 256;
    scene.rig.height = 144;
    scene.supersampling = 1;
    fs::create_directories(folder_ / "left");
    fs::create_directories(folder_ / "right");
    for (int i = 0; i < distinct_frames; ++i) {
      const synth::SyntheticPair pair = synth::render(synth::next_frame(scene, i));
      write("left/" + std::to_string(i) + ".png", io::encode_png(pair.left.view()));
      write("right/" + std::to_string(i) + ".png", io::encode_png(pair.right.view()));
      if (i > 0) continue;
      rig_ = pair.calibration;
      write("rig.yaml", "focal_px: " + std::to_string(rig_.focal_px) + "\ncx_px: " + std::to_string(rig_.cx_px) +
                            "\ncy_px: " + std::to_string(rig_.cy_px) + "\nbaseline_m: 0.12\nwidth: 256\nheight: 144\n");
    }
  }

  /// A flight to and fro over the same frames, `frames` of them, ten a second.
  void write_list(int frames) const {
    std::string list;
    for (int i = 0; i < frames; ++i) {
      const int turn = i % (2 * distinct_frames - 2);
      const std::string name = std::to_string(turn < distinct_frames ? turn : 2 * distinct_frames - 2 - turn) + ".png";
      list += "left/" + name + " right/" + name + " " + std::to_string(0.1 * i) + "\n";
    }
    write("flight.txt", list);
  }

  std::vector<std::string> rows(const std::string& name) const { return lines_of(read_text(folder_ / name)); }

  /// frames.csv without what a clock tells.
  std::vector<std::vector<std::string>> figures(const std::string& output) const {
    std::vector<std::vector<std::string>> table;
    for (const std::string& row : rows(output + "/frames.csv")) {
      std::vector<std::string> cells = cells_of(row);
      cells.erase(cells.begin() + 21, cells.begin() + 23);  // matching_ms, damage_ms
      table.push_back(cells);
    }
    return table;
  }

  /// Every file of a folder of results but those that tell the time of processing.
  std::map<std::string, std::string> files(const std::string& output) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / output)) {
      const std::string name = fs::relative(entry.path(), folder_ / output).string();
      const bool timed = name == "frames.csv" || name == "summary.json" || name == "report.html" ||
                         name == "flight/journal.jsonl" || name == "flight/lock";
      if (entry.is_regular_file() && !timed) all[name] = read_text(entry.path());
    }
    return all;
  }

  void expect_same(const std::string& output, const std::string& expected) const {
    EXPECT_EQ(figures(output), figures(expected));
    const auto found = files(output);
    const auto wanted = files(expected);
    ASSERT_EQ(found.size(), wanted.size());
    for (const auto& [name, content] : wanted) {
      ASSERT_TRUE(found.count(name)) << name;
      EXPECT_TRUE(found.at(name) == content) << name << " differs";
    }
  }

  /// Starts `inspect` with these words and leaves it running.
  pid_t start(const std::vector<std::string>& words) const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(folder_.c_str()) != 0) ::_exit(127);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    std::vector<char*> arguments{const_cast<char*>(ROADSTEREO_BINARY), const_cast<char*>("inspect")};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(ROADSTEREO_BINARY, arguments.data());
    ::_exit(127);
  }

  void wait_for_lines(const std::string& journal, std::size_t least) const {
    const auto is_there = [&] {
      return std::filesystem::exists(folder_ / journal) && lines_of(read_text(folder_ / journal)).size() >= least;
    };
    for (int i = 0; i < 20000 && !is_there(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  static int end_of(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }

  StereoCalibration rig_;
};

using SlowFlightCommand = FlightCommand;

TEST_F(FlightCommand, MaskHoldsForEveryFrame) {
  write_list(3);
  Frame mask{std::vector<std::uint8_t>(std::size_t{256} * 144, 0), 256, 144};
  std::fill_n(mask.bytes.begin(), mask.bytes.size() / 2, std::uint8_t{255});
  write("mask.png", io::encode_png(mask.view()));
  const std::string flight = "inspect flight.txt --calibration rig.yaml --output out --write disparity --mask ";
  ASSERT_EQ(run(flight + "mask.png").exit_code, 0);
  int maps = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
    if (entry.path().extension() != ".tiff") continue;
    const Image<float> disparity = io::read_disparity(entry.path().string());
    EXPECT_TRUE(std::isnan(disparity(200, 71)));
    EXPECT_FALSE(std::isnan(disparity(200, 100)));
    ++maps;
  }
  EXPECT_EQ(maps, 3);
  mask.height = 72;
  mask.bytes.resize(mask.bytes.size() / 2);
  write("mask.png", io::encode_png(mask.view()));
  expect_complaint(run(flight + "mask.png --quiet"), "mask.png has 256×72 pixels");
}

TEST_F(FlightCommand, FolderGivesTablesReportAndPictures) {
  write("left/1.png", std::string("no picture"));
  const Outcome outcome = run("inspect . --calibration rig.yaml --output out --rate 10 --write disparity,cloud");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("4 (1 rejected, 0 failed)"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("4 of 4 frames"), std::string::npos) << outcome.err;
  const std::vector<std::string> frames = rows("out/frames.csv");
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[1].rfind("0,0,0,good,", 0), 0U) << frames[1];
  EXPECT_EQ(frames[2].rfind("1,1,0.1,rejected,", 0), 0U) << frames[2];
  EXPECT_NE(frames[2].find("left/1.png"), std::string::npos) << frames[2];
  EXPECT_NE(frames[3].find(",tracked,"), std::string::npos) << "over the frame that is missing: " << frames[3];
  const nlohmann::json summary = json_file("out/summary.json");
  EXPECT_EQ(summary["frames"]["good"], 3);
  EXPECT_EQ(summary["frames"]["rejected"], 1);
  EXPECT_TRUE(summary["run"]["complete"].get<bool>());
  EXPECT_NEAR(summary["height_m"]["median"].get<double>(), synth::named_scene("uav").rig.camera_height_m, 0.3);
  EXPECT_EQ(summary["damages"]["sightings"], rows("out/sightings.csv").size() - 1);
  EXPECT_EQ(summary["damages"]["total"], rows("out/damages.csv").size() - 1);
  EXPECT_EQ(summary["damages"]["candidates"], rows("out/candidates.csv").size() - 1);
  EXPECT_GT(fs::file_size(folder_ / "out/report.html"), 10000U);
  for (const int i : {0, 2, 3}) {
    EXPECT_EQ(
        io::read_disparity((folder_ / "out/disparity" / ("00000" + std::to_string(i) + ".tiff")).string()).width(),
        256);
    EXPECT_TRUE(fs::exists(folder_ / "out/cloud" / ("00000" + std::to_string(i) + ".ply")));
  }
  EXPECT_FALSE(fs::exists(folder_ / "out/disparity/000001.tiff"));
}

TEST_F(FlightCommand, FromToAndEverySelectFrames) {
  write_list(12);
  const Outcome outcome = run("inspect flight.txt --output out --from 2 --to 9 --every 3 --json --quiet");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["frames"]["total"], 3);
  std::vector<std::string> taken;
  for (const std::string& row : rows("out/frames.csv")) taken.push_back(row.substr(0, row.find(',')));
  EXPECT_EQ(taken, (std::vector<std::string>{"frame", "2", "5", "8"}));
  const auto health = nlohmann::json::parse(outcome.out)["health"];
  EXPECT_TRUE(health["depth_is_trusted"]);
  EXPECT_EQ(health["lost_share"], 0);
  EXPECT_NEAR(health["gain"], 1, 0.01);
}

TEST_F(FlightCommand, SecondRunReplacesFirst) {
  write_list(6);
  EXPECT_EQ(run("inspect flight.txt --output out --write disparity --quiet").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/disparity/000005.tiff"));
  EXPECT_EQ(run("inspect flight.txt --output out --to 1 --quiet").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "out/disparity/000005.tiff"));
  EXPECT_EQ(rows("out/frames.csv").size(), 3U);
}

TEST_F(SlowFlightCommand, ResumesAfterCutJournal) {
  write_list(9);
  const std::string command = "inspect flight.txt --calibration rig.yaml --write disparity,mcap --quiet --output ";
  ASSERT_EQ(run(command + "whole").exit_code, 0);
  const std::vector<std::string> journal = rows("whole/flight/journal.jsonl");
  ASSERT_EQ(journal.size(), 10U);
  for (const std::size_t frames : {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size_t{9}}) {
    // As a kill leaves it: some frames done, half a line of the next, its file there already, a staging folder.
    fs::remove_all(folder_ / "cut");
    fs::copy(folder_ / "whole", folder_ / "cut", fs::copy_options::recursive);
    for (const char* result :
         {"frames.csv", "pose.csv", "damages.csv", "sightings.csv", "summary.json", "report.html"}) {
      fs::remove(folder_ / "cut" / result);
    }
    std::string text;
    for (std::size_t i = 0; i <= frames; ++i) text += journal[i] + "\n";
    if (frames < 9) {
      text += journal[frames + 1].substr(0, 100);
      fs::resize_file(folder_ / "cut/flight.mcap",
                      fs::file_size(folder_ / "whole/flight.mcap") * (2 * frames + 1) / 18);
    }
    write("cut/flight/journal.jsonl", text);
    fs::create_directories(folder_ / "cut/.roadstereo-abcdef/new");
    write("cut/.roadstereo-abcdef/new/frames.csv", std::string("half"));
    const Outcome outcome = run(command + "cut --resume");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(json_file("cut/summary.json")["run"]["resumed_at_frame"], frames);
    expect_same("cut", "whole");
  }
}

TEST_F(FlightCommand, ResumesAfterKillWithoutBrokenFile) {
  write_list(40);
  const std::vector<std::string> words{"flight.txt", "--calibration",  "rig.yaml",
                                       "--write",    "disparity,mcap", "--output"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  ASSERT_EQ(end_of(start(with({"whole"}))), 0);
  for (const std::size_t lines : {std::size_t{2}, std::size_t{9}, std::size_t{20}}) {
    const pid_t child = start(with({"killed", "--resume"}));
    wait_for_lines("killed/flight/journal.jsonl", lines);
    ::kill(child, SIGKILL);
    end_of(child);
    for (const auto& entry : fs::directory_iterator(folder_ / "killed/disparity")) {
      EXPECT_EQ(io::read_disparity(entry.path().string()).width(), 256) << entry.path();
    }
  }
  EXPECT_EQ(end_of(start(with({"killed", "--resume"}))), 0);
  expect_same("killed", "whole");
}

TEST_F(FlightCommand, CtrlCEndsAfterFramesInFlight) {
  write_list(5000);
  const pid_t child = start({"flight.txt", "--output", "out", "--preset", "fast"});
  wait_for_lines("out/flight/journal.jsonl", 4);
  ::kill(child, SIGINT);
  const int status = end_of(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::size_t frames = rows("out/frames.csv").size() - 1;
  EXPECT_GE(frames, 3U);
  EXPECT_LT(frames, 5000U);
  EXPECT_EQ(rows("out/flight/journal.jsonl").size(), frames + 1);
  EXPECT_FALSE(json_file("out/summary.json")["run"]["complete"].get<bool>());
  EXPECT_NE(read_text(folder_ / "out/report.html").find("was interrupted"), std::string::npos);
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    EXPECT_NE(entry.path().filename().string()[0], '.') << "left over: " << entry.path();
  }
}

TEST_F(FlightCommand, CtrlCEndsProgramThatWaitsForSource) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.txt").c_str(), 0600), 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = start({"pipe.txt", "--output", "out"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ::kill(child, signal);
    const int status = end_of(child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
  }
}

TEST_F(FlightCommand, ResumesNamesThatAreNotUtf8) {
  fs::create_directories(folder_ / "fl\xfcg/left");
  fs::create_directories(folder_ / "fl\xfcg/right");
  for (int i = 0; i < distinct_frames; ++i) {
    for (const char* side : {"left", "right"}) {
      fs::copy(folder_ / side / (std::to_string(i) + ".png"),
               folder_ / "fl\xfcg" / side / ("\xff" + std::to_string(i) + ".png"));
    }
  }
  const std::string command = "inspect fl\xfcg --output out --quiet ";
  ASSERT_EQ(run(command + "--to 1").exit_code, 0);
  const Outcome outcome = run(command + "--resume");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(rows("out/frames.csv").size(), 1U + distinct_frames);
}

TEST_F(FlightCommand, PairIsNotWrittenIntoFlight) {
  write_list(3);
  ASSERT_EQ(run("inspect flight.txt --output out --quiet").exit_code, 0);
  const std::string report = read_text(folder_ / "out/report.html");
  expect_complaint(run("inspect left/0.png right/0.png --output out --quiet"), "results of a recording");
  EXPECT_EQ(read_text(folder_ / "out/report.html"), report);
}

TEST_F(FlightCommand, IsNotWrittenIntoResultsOfPair) {
  write_list(3);
  ASSERT_EQ(run("inspect left/0.png right/0.png --output out --quiet").exit_code, 0);
  const std::string report = read_text(folder_ / "out/report.html");
  expect_complaint(run("inspect flight.txt --output out --quiet"), "results of a pair");
  EXPECT_EQ(read_text(folder_ / "out/report.html"), report);
}

/// A road in the first frame, then nothing but noise.
TEST_F(FlightCommand, TellsInHowManyFramesThereIsNoRoad) {
  write_list(5);
  std::mt19937 random(1);
  Frame noise{std::vector<std::uint8_t>(std::size_t{256} * 144), 256, 144};
  for (const char* name : {"left/1.png", "right/1.png", "left/2.png", "right/2.png"}) {
    std::generate(noise.bytes.begin(), noise.bytes.end(), [&] { return static_cast<std::uint8_t>(random() >> 24); });
    write(name, io::encode_png(noise.view()));
  }
  const Outcome outcome = run("inspect flight.txt --calibration rig.yaml --output out --to 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Damage could not be searched for in 2 of 3 frames"), std::string::npos) << outcome.out;
  const std::string report = read_text(folder_ / "out/report.html");
  EXPECT_NE(report.find("Damage could not be searched for in 2 of 3 frames"), std::string::npos);
  EXPECT_EQ(report.find("No damage found.</strong>"), std::string::npos) << "without a word of the other frames";
  EXPECT_EQ(json_file("out/summary.json")["frames"]["inspected"], 1);
}

/// A height that is not that of the road is told for the whole recording; one that is, is not.
TEST_F(FlightCommand, TellsThatHeightIsNotWhatWasExpected) {
  write_list(3);
  const std::string command = "inspect flight.txt --calibration rig.yaml --output out --height ";
  const Outcome outcome = run(command + "30");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file("out/summary.json");
  ASSERT_EQ(summary["notices"].size(), 1U);
  const std::string notice = summary["notices"][0];
  EXPECT_NE(notice.find("not 30 m as expected; check the unit of the baseline in rig.yaml"), std::string::npos)
      << notice;
  EXPECT_NE(outcome.out.find(notice), std::string::npos) << outcome.out;
  EXPECT_NE(read_text(folder_ / "out/report.html").find(notice), std::string::npos);
  EXPECT_GT(summary["health"]["frames_with"].value("unexpected-pose", 0), 0);
  EXPECT_TRUE(summary["track"].is_null());
  const double height_m = summary["height_m"]["median"];
  ASSERT_EQ(run(command + std::to_string(height_m)).exit_code, 0);
  EXPECT_TRUE(json_file("out/summary.json")["notices"].empty());
}

/// 12 bits in 16: two dark pairs that 10 bits would hold, then two bright ones.
TEST_F(FlightCommand, WhiteLevelRisesWithPictures) {
  for (int i = 0; i < distinct_frames; ++i) {
    for (const std::string side : {"left/", "right/"}) {
      const std::string file = side + std::to_string(i) + ".png";
      const Frame narrow = io::read_frame((folder_ / file).string());
      Frame wide{std::vector<std::uint8_t>(2 * narrow.bytes.size()), narrow.width, narrow.height, SampleType::u16,
                 narrow.order};
      for (std::size_t k = 0; k < narrow.bytes.size(); ++k) {
        const unsigned sample = narrow.bytes[k] * (i < 2 ? 4U : 16U);
        wide.bytes[2 * k] = static_cast<std::uint8_t>(sample & 255U);
        wide.bytes[2 * k + 1] = static_cast<std::uint8_t>(sample >> 8U);
      }
      write(file, io::encode_png(wide.view()));
    }
  }
  write_list(4);
  const std::string flight = "inspect flight.txt --calibration rig.yaml --trajectory --quiet --output ";
  ASSERT_EQ(run(flight + "whole").exit_code, 0);
  EXPECT_EQ(json_file("whole/summary.json")["frames"]["good"], 4);
  EXPECT_EQ(json_file("whole/summary.json")["options"]["white_level"], 4095);
  EXPECT_EQ(json_file("whole/summary.json")["inputs"]["finds_white_level"], true);
  for (const std::string last : {"1", "2"}) {
    ASSERT_EQ(run(flight + "cut --to " + last).exit_code, 0);
    ASSERT_EQ(run(flight + "cut --resume").exit_code, 0);
    expect_same("cut", "whole");
  }
}

TEST_F(FlightCommand, ResumeLeavesNothingOfAnEarlierRun) {
  write_list(3);
  write("track.csv", std::string("time,lat,lon\n0,48.5,9.05\n1,48.5001,9.05\n"));
  const std::string flight = "inspect flight.txt --calibration rig.yaml --output out --quiet ";
  ASSERT_EQ(run(flight + "--track track.csv --trajectory").exit_code, 0);
  ASSERT_TRUE(fs::exists(folder_ / "out/segments.csv"));
  ASSERT_TRUE(fs::exists(folder_ / "out/trajectory_kitti.txt"));
  ASSERT_EQ(run(flight + "--resume").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "out/segments.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "out/damages.geojson"));
  EXPECT_FALSE(fs::exists(folder_ / "out/trajectory_kitti.txt"));
  expect_complaint(run(flight + "--resume --to 1"), "frames up to 2 are finished; --to is 1");
}

TEST_F(FlightCommand, ListInOutputFolderIsKept) {
  write_list(3);
  write("frames.csv", read_text(folder_ / "flight.txt"));
  const std::string list = read_text(folder_ / "frames.csv");
  expect_complaint(run("inspect frames.csv --output . --quiet"), "would be overwritten");
  EXPECT_EQ(read_text(folder_ / "frames.csv"), list);
}

// A second run removes the pictures of the first one, and whatever else lies in their folder.
TEST_F(FlightCommand, CalibrationInFolderOfPicturesIsKept) {
  write_list(3);
  fs::create_directories(folder_ / "out/damages");
  fs::copy(folder_ / "rig.yaml", folder_ / "out/damages/rig.yaml");
  expect_complaint(run("inspect flight.txt --calibration out/damages/rig.yaml --output out --quiet"),
                   "would be overwritten");
  EXPECT_TRUE(fs::exists(folder_ / "out/damages/rig.yaml"));
}

TEST_F(FlightCommand, RejectsResumeOfOtherFlight) {
  write_list(3);
  EXPECT_EQ(run("inspect flight.txt --output out --quiet").exit_code, 0);
  expect_complaint(run("inspect flight.txt --output out --quiet --resume --every 2"), "--every \"1\", not \"2\"");
  expect_complaint(run("inspect flight.txt --output out --quiet --resume --preset fast"), "started with");
  EXPECT_EQ(run("inspect flight.txt --output out --quiet --resume --threads 1").exit_code, 0)
      << "threads change nothing";
}

TEST_F(FlightCommand, ResumeNeedsSameFramesAndCalibration) {
  write_list(6);
  const std::string command = "inspect flight.txt --calibration rig.yaml --output out --quiet ";
  EXPECT_EQ(run(command + "--to 2").exit_code, 0);
  const std::string rig = read_text(folder_ / "rig.yaml");
  write("rig.yaml", rig + "# another line\n");
  expect_complaint(run(command + "--resume"), "content of the calibration");
  write("rig.yaml", rig);
  const std::string list = read_text(folder_ / "flight.txt");
  write("flight.txt", list.substr(list.find('\n') + 1));  // without the first frame
  expect_complaint(run(command + "--resume"), "frame 2 was \"2\" and is now \"3\"");
  write("flight.txt", list);
  EXPECT_EQ(run(command + "--resume").exit_code, 0);
  EXPECT_EQ(rows("out/frames.csv").size(), 7U);
}

TEST_F(FlightCommand, ResumeNeedsItsMcapFile) {
  write_list(3);
  const std::string command = "inspect flight.txt --output out --write mcap --quiet ";  // without a calibration
  ASSERT_EQ(run(command + "--to 1").exit_code, 0);
  const std::string file = read_text(folder_ / "out/flight.mcap");
  for (const std::size_t size : {file.size() / 3, std::size_t{20}}) {
    write("out/flight.mcap", file.substr(0, size));
    expect_complaint(run(command + "--resume"), size == 20 ? "is not the one that the flight has begun" : "0 of the 2");
  }
  fs::remove(folder_ / "out/flight.mcap");
  expect_complaint(run(command + "--resume"), "flight.mcap: the file is missing");
  write("out/flight.mcap", file);
  EXPECT_EQ(run(command + "--resume").exit_code, 0);
  EXPECT_GT(fs::file_size(folder_ / "out/flight.mcap"), file.size());
  EXPECT_EQ(run("inspect flight.txt --output out --quiet").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "out/flight.mcap")) << "it was that of an earlier flight";
}

TEST_F(FlightCommand, McapNeedsTimesOfRos) {
  write("flight.txt", std::string("left/0.png right/0.png -1\n"));
  expect_complaint(run("inspect flight.txt --output out --write mcap --quiet"), "frame 0: a frame has the time -1 s");
}

TEST_F(FlightCommand, ResumeNeedsSameCalibrationOfSource) {
  write_list(3);
  write("calibration.yaml", read_text(folder_ / "rig.yaml"));
  const std::string command = "inspect flight.txt --output out --quiet ";
  EXPECT_EQ(run(command + "--to 1").exit_code, 0);
  write("calibration.yaml", read_text(folder_ / "rig.yaml") + "# another line\n");
  expect_complaint(run(command + "--resume"), "content of the calibration");
}

TEST_F(FlightCommand, MistypedOptionKeepsEarlierResult) {
  write_list(3);
  EXPECT_EQ(run("inspect flight.txt --output out --quiet").exit_code, 0);
  const std::string frames = read_text(folder_ / "out/frames.csv");
  expect_complaint(run("inspect flight.txt --output out --quiet --threads -1"), "threads is -1");
  expect_complaint(run("inspect flight.txt --output out --quiet --from 3"), "has 3 frames");
  expect_complaint(run("inspect flight.txt --output out --quiet --engine abacus"), "abacus");
  EXPECT_EQ(read_text(folder_ / "out/frames.csv"), frames);
}

TEST_F(FlightCommand, ContinuesWithoutReaderOfStdout) {
  write_list(3);
  EXPECT_EQ(std::system(("cd '" + folder_.string() +
                         "' && '" ROADSTEREO_BINARY "' inspect flight.txt --output out >/dev/null 2>/dev/full")
                            .c_str()),
            0);
  EXPECT_EQ(rows("out/frames.csv").size(), 4U);
  const int status =
      std::system(("'" ROADSTEREO_BINARY "' inspect nowhere --output '" + folder_.string() + "' 2>&-").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST_F(FlightCommand, LocksOutputFolder) {
  write_list(3);
  fs::create_directories(folder_ / "out/flight");
  const int lock = ::open((folder_ / "out/flight/lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  expect_complaint(run("inspect flight.txt --output out --quiet"), "another process is writing");
  ::close(lock);
  EXPECT_EQ(run("inspect flight.txt --output out --quiet").exit_code, 0);
}

TEST_F(FlightCommand, NamesLimitOfOpenFiles) {
  write_list(3);
  expect_complaint(run("inspect flight.txt --output out --quiet", "prlimit --nofile=5"), 1, "Too many open files");
}

TEST_F(FlightCommand, RejectsBadInput) {
  write_list(3);
  expect_complaint(run("inspect flight.txt --output out --write everything"), "--write has \"everything\"");
  expect_complaint(run("inspect flight.txt --output out --write cloud"), "needs --calibration");
  expect_complaint(run("inspect flight.txt --output out --from 2 --to 1"), "--to is 1");
  expect_complaint(run("inspect flight.txt --output out --every 0"), "--every is 0");
  expect_complaint(run("inspect flight.txt --output out --every 9223372036854775807"), "between 1 and 1000000000");
  expect_complaint(run("inspect flight.txt --output out --layout upside-down"), "the layout is \"upside-down\"");
  expect_complaint(run("inspect nowhere --output out"), "nowhere: no such file");
  expect_complaint(run("inspect left/0.png --output out"), "give two images");
  for (const std::string option : {"--resume", "--camera-size 0x0"}) {
    expect_complaint(run("inspect left/0.png right/0.png " + option + " --output out"),
                     option.substr(0, option.find(' ')) + " is for recordings only");
  }
  EXPECT_FALSE(fs::exists(folder_ / "out")) << "nothing was begun";
  write("blank.txt", "left/0.png left/0.png\n");
  expect_complaint(run("inspect blank.txt --output out --quiet"), "none of the 1 frames could be matched");
  EXPECT_EQ(rows("out/frames.csv").size(), 2U) << "the reason is on record all the same";
}

}  // namespace
}  // namespace roadstereo

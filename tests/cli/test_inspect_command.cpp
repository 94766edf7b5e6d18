// `inspect` of one pair from outside: exit code, what it prints, what it leaves on disk.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/options.hpp"
#include "tests/cli/road_command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;
using InspectCommand = RoadCommandTest;

const std::set<std::string> result_files = {
    "disparity.tiff", "transformed.tiff", "disparity.png", "disparity_color.png", "transformed_color.png", "sheet.png",
    "sigma.tiff",     "sigma_color.png",  "result.json",   "damages.json",        "damages.csv",           "damage.png",
    "overlay.png",    "report.html",      "cloud.ply",     "road_cloud.ply"};

// The demo's deepest pothole is 3 px deep.
TEST_F(InspectCommand, TellsWhereSearchEndsAtFloor) {
  ASSERT_EQ(run("synth --scene demo --size 640x360 --output demo --quiet").exit_code, 0);
  const std::string pair =
      "inspect demo/left.png demo/right.png --calibration demo/calibration.yaml --quiet --output out";
  const auto tells = [this](const std::string& command) {
    EXPECT_EQ(run(command).exit_code, 0);
    const nlohmann::json codes = json_file("out/result.json")["warning_codes"];
    return std::find(codes.begin(), codes.end(), "search-end") != codes.end();
  };
  EXPECT_FALSE(tells(pair));
  EXPECT_TRUE(tells(pair + " --set perspective.delta_p_px=1"));
  const nlohmann::json deepest = json_file("out/damages.json")["damages"][0];
  EXPECT_GE(deepest["max_depth_m_stderr"], deepest["max_depth_m"]);
}

TEST_F(InspectCommand, WritesEveryFile) {
  make_road();
  const Outcome outcome = inspect();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(names_in(folder_ / "result"), result_files);
  for (const char* part : {"roll", "valid", "sigma_d", "ms", "result/sheet.png"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  }
  EXPECT_LE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 24) << "more than one screen";
}

/// The calibration of pictures twice as large, in a format without a size.
TEST_F(InspectCommand, ScaledPicturesAreSuspected) {
  make_road();
  write("K.txt", std::string("350 0 319.5 0 350 179.5 0 0 1\n0.12\n"));
  const Outcome outcome = run("inspect road/left.png road/right.png --calibration K.txt --output scaled");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto codes = json_file("scaled/result.json")["warning_codes"];
  EXPECT_NE(std::find(codes.begin(), codes.end(), "calibration-size"), codes.end()) << codes;
  EXPECT_NE(outcome.out.find("K.txt: it has no image size"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("it suggests 640×360"), std::string::npos) << outcome.out;
}

TEST_F(InspectCommand, FindsTrueRoad) {
  make_road();
  ASSERT_EQ(inspect().exit_code, 0);
  const auto truth = json_file("road/truth.json");
  const auto result = json_file("result/result.json");
  for (const double v : {60.0, 179.0}) {
    for (const double u : {0.0, 319.0}) {
      const auto at = [&](const nlohmann::json& plane) {
        return plane["a0"].get<double>() + plane["a1"].get<double>() * v + plane["a2"].get<double>() * u;
      };
      EXPECT_NEAR(at(result["road_model"]), at(truth["plane"]), 0.2) << u << ", " << v;
    }
  }
  EXPECT_NEAR(result["roll_rad"].get<double>(), truth["roll_rad"].get<double>(), 0.005);
  EXPECT_NEAR(result["camera_height_m"].get<double>(), truth["rig"]["camera_height_m"].get<double>(), 0.05);
  const double pitch_deg = result["camera_pitch_rad"].get<double>() * 180 / 3.14159265358979;
  EXPECT_NEAR(pitch_deg, truth["rig"]["pitch_deg"].get<double>(), 1.0);
}

TEST_F(InspectCommand, ResultJsonHasEveryOptionAndFigure) {
  make_road();
  ASSERT_EQ(inspect("--calibration road/calibration.yaml --preset paper --threads 2").exit_code, 0);
  const auto result = json_file("result/result.json");
  for (const char* key :
       {"version",         "inputs",          "size",       "preset",  "options",     "engine",
        "threads",         "calibration",     "road_model", "alpha0",  "alpha1",      "roll_rad",
        "roll_stderr_rad", "roll_observable", "delta_p",    "delta_t", "disparities", "valid_fraction",
        "sigma_d_px",      "sigma_d_all_px",  "rows",       "road",    "ms",          "mde_per_s",
        "warnings"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  for (const auto& option : list_options(preset("paper"))) {
    EXPECT_TRUE(result["options"].contains(option.key)) << option.key;
  }
  EXPECT_EQ(result["preset"], "paper");
  EXPECT_EQ(result["threads"], 2);
}

/// Roll, camera height and road of the truth, from the map of the truth itself.
TEST_F(InspectCommand, GivenDisparityIsUsedInsteadOfMatching) {
  make_road();
  const auto truth = json_file("road/truth.json");
  const auto expect_truth = [&](const std::string& arguments) {
    const Outcome outcome = run("inspect " + arguments + " --calibration road/calibration.yaml --output result");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("the disparities are those of "), std::string::npos) << outcome.out;
    const auto result = json_file("result/result.json");
    EXPECT_NEAR(result["roll_rad"].get<double>(), truth["roll_rad"].get<double>(), 0.006) << "0.005 by camber";
    EXPECT_NEAR(result["camera_height_m"].get<double>(), truth["rig"]["camera_height_m"].get<double>(), 0.01);
    EXPECT_TRUE(result["engine"].is_null());
    const auto damages = json_file("result/damages.json")["damages"];
    EXPECT_GE(damages.size(), 2U) << "both potholes";
    double deepest = 0;
    for (const auto& damage : truth["damages"]) deepest = std::max(deepest, damage["depth_m"].get<double>());
    ASSERT_FALSE(damages.empty());
    EXPECT_NEAR(damages[0]["max_depth_m"].get<double>(), deepest, 0.005);
  };
  expect_truth("road/left.png --disparity road/truth_disparity.tiff");
  std::set<std::string> files = result_files;
  files.erase("sigma.tiff");
  files.erase("sigma_color.png");
  EXPECT_EQ(names_in(folder_ / "result"), files);
  EXPECT_EQ(json_file("result/result.json")["inputs"]["disparity"], "road/truth_disparity.tiff");
  EXPECT_TRUE(json_file("result/result.json")["inputs"]["right"].is_null());
  expect_truth("road/left.png road/right.png --disparity road/truth_disparity.tiff");
  write("truth.png", io::encode_kitti_png(io::read_disparity((folder_ / "road/truth_disparity.tiff").string())));
  expect_truth("road/left.png --disparity truth.png");
}

TEST_F(InspectCommand, RejectsGivenDisparityThatDoesNotFit) {
  make_road();
  write("small.tiff", io::encode_float_tiff(Image<float>(64, 64, 1)));
  expect_complaint(run("inspect road/left.png --disparity small.tiff --output out"),
                   "64×64 pixels; it must have 320×180");
  expect_complaint(run("inspect road --disparity small.tiff --output out"), "road is a recording");
  expect_complaint(run("inspect road/left.png --disparity none.tiff --output out"), "none.tiff");
  expect_complaint(run("inspect road/left.png --disparity road/truth_disparity.tiff --height 1 --calibration "
                       "road/calibration.yaml --output out"),
                   "need RIGHT");
  write("empty.tiff", io::encode_float_tiff(Image<float>(320, 180, -1)));
  const Outcome outcome = run("inspect road/left.png --disparity empty.tiff --output out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("no road was found: "), std::string::npos) << outcome.out;
}

TEST_F(InspectCommand, WithoutCalibrationNothingIsMetric) {
  make_road();
  const Outcome outcome = inspect("");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = json_file("result/result.json");
  EXPECT_TRUE(result["calibration"].is_null());
  EXPECT_TRUE(result["camera_height_m"].is_null());
  EXPECT_TRUE(result["camera_pitch_rad"].is_null());
  EXPECT_EQ(outcome.out.find(" m above"), std::string::npos);
}

TEST_F(InspectCommand, QuietPrintsNothingAndJsonPrintsResult) {
  make_road();
  const Outcome quiet = inspect("--quiet");
  EXPECT_EQ(quiet.exit_code, 0) << quiet.err;
  EXPECT_EQ(quiet.out + quiet.err, "");
  const Outcome json = inspect("--json");
  EXPECT_EQ(json.out, read_text(folder_ / "result/result.json"));
}

TEST_F(InspectCommand, SigmaIsDefinedWhereDisparityIs) {
  make_road();
  ASSERT_EQ(inspect("--quiet").exit_code, 0);
  const auto disparity = io::read_disparity((folder_ / "result/disparity.tiff").string());
  const auto sigma = io::read_disparity((folder_ / "result/sigma.tiff").string());
  ASSERT_EQ(sigma.width(), 320);
  ASSERT_EQ(sigma.height(), 180);
  std::vector<float> known;
  for (int v = 0; v < sigma.height(); ++v) {
    for (int u = 0; u < sigma.width(); ++u) {
      ASSERT_EQ(std::isnan(sigma(u, v)), std::isnan(disparity(u, v))) << u << ", " << v;
      if (!std::isnan(sigma(u, v))) known.push_back(sigma(u, v));
    }
  }
  std::sort(known.begin(), known.end());
  EXPECT_GT(known.front(), 0);
  const double median = json_file("result/result.json")["sigma_px"];
  EXPECT_GE(median, known[(known.size() - 1) / 2] - 1e-6);
  EXPECT_LE(median, known[known.size() / 2] + 1e-6);
  EXPECT_GT(io::read_frame((folder_ / "result/sigma_color.png").string()).width, 320);  // map and scale bar
}

TEST_F(InspectCommand, MaskLeavesOutWhitePixels) {
  make_road();
  const auto mask = [&](const std::string& name, int width, int height) {
    Frame frame{std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), 0), width, height};
    std::fill(frame.bytes.begin() + frame.bytes.size() / 2, frame.bytes.end(), 255);
    frame.bytes.front() = 254;  // only white is left out
    write(name, io::encode_png(frame.view()));
  };
  mask("mask.png", 320, 180);
  mask("small.png", 300, 180);
  const Outcome outcome = inspect("--calibration road/calibration.yaml --mask mask.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto disparity = io::read_disparity((folder_ / "result/disparity.tiff").string());
  int above = 0;
  for (int u = 0; u < 320; ++u) {
    above += std::isnan(disparity(u, 60)) ? 0 : 1;
    EXPECT_TRUE(std::isnan(disparity(u, 90))) << u;
    EXPECT_TRUE(std::isnan(disparity(u, 179))) << u;
  }
  EXPECT_GT(above, 250);
  EXPECT_EQ(json_file("result/result.json")["inputs"]["mask"], "mask.png");
  expect_complaint(inspect("--mask small.png"), "small.png has 300×180 pixels; --mask must have 320×180");
  expect_complaint(inspect("--mask absent.png"), "absent.png");
}

TEST_F(InspectCommand, ExpectedHeightIsCompared) {
  make_road();
  const std::string calibrated = "--calibration road/calibration.yaml ";
  const double height = 2.4;  // of scene demo
  ASSERT_EQ(inspect(calibrated + "--height 2.5 --pitch 60").exit_code, 0);
  EXPECT_NEAR(json_file("result/result.json")["camera_height_m"].get<double>(), height, 0.1);
  EXPECT_EQ(json_file("result/result.json")["warnings"].size(), 0U);
  ASSERT_EQ(inspect(calibrated + "--height 4").exit_code, 0);
  const auto warnings = json_file("result/result.json")["warnings"];
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].get<std::string>().find("not 4 m as expected"), std::string::npos) << warnings;
  expect_complaint(inspect("--height 2"), "need a calibration");
  expect_complaint(inspect(calibrated + "--pitch 100"), "road_model.pitch_deg is 100");
}

TEST_F(InspectCommand, ResultIsIndependentOfThreads) {
  make_road();
  ASSERT_EQ(inspect("--threads 1").exit_code, 0);
  const std::string one = read_text(folder_ / "result/disparity.tiff");
  ASSERT_EQ(inspect("--threads 3").exit_code, 0);
  EXPECT_EQ(one, read_text(folder_ / "result/disparity.tiff"));
}

TEST_F(InspectCommand, SetTakesOneOrSeveral) {
  make_road();
  const std::string pair = "road/left.png road/right.png ";
  ASSERT_EQ(run("inspect --set matcher.block_radius=4 " + pair + "--output result").exit_code, 0);
  EXPECT_EQ(json_file("result/result.json")["options"]["matcher.block_radius"], 4);
  ASSERT_EQ(inspect("--set matcher.block_radius=3 matcher.sub_pixel=false --set check_rows=false").exit_code, 0);
  const auto options = json_file("result/result.json")["options"];
  EXPECT_EQ(options["matcher.block_radius"], 3);
  EXPECT_EQ(options["matcher.sub_pixel"], false);
  EXPECT_EQ(options["check_rows"], false);
}

TEST_F(InspectCommand, RejectsBadSettings) {
  make_road();
  expect_complaint(inspect("--set matcher.sigma_spce=2"), 2, "matcher.sigma_space");
  expect_complaint(inspect("--set matcher.sigma_space"), 2, "key=value");
  expect_complaint(inspect("--set matcher.sigma_space=wide"), 2, "wide");
  expect_complaint(inspect("--set matcher.block_radius=-3"), 2, "block_radius");
  expect_complaint(inspect("--preset papre"), 2, "paper");
  expect_complaint(inspect("--engine quantum"), 2, "reference");
  expect_complaint(inspect("--threads -1"), 2, "threads");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(InspectCommand, RejectsUnreadableImages) {
  make_road();
  write_text(folder_ / "text.png", "this is no image");
  const std::string output = " --output result";
  expect_complaint(run("inspect absent.png road/right.png" + output), 2, "absent.png");
  expect_complaint(run("inspect road/left.png text.png" + output), 2, "text.png");
  expect_complaint(run("inspect road road/right.png" + output), 2, "road");
  write_text(folder_ / "cut.png", read_text(folder_ / "road/left.png").substr(0, 5000));
  expect_complaint(run("inspect cut.png road/right.png" + output), 2, "cut.png");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(InspectCommand, RejectsImagesThatAreNoPair) {
  make_road();
  ASSERT_EQ(run("synth --size 300x180 --output other").exit_code, 0);
  write_text(folder_ / "black.pgm", "P5 320 180 255\n" + std::string(320 * 180, '\0'));
  const std::string output = " --output result";
  const Outcome sizes = run("inspect road/left.png other/right.png" + output);
  expect_complaint(sizes, 2, "320×180");
  expect_complaint(sizes, 2, "300×180");
  expect_complaint(run("inspect black.pgm black.pgm" + output), 2, "");
  expect_complaint(run("inspect road/left.png black.pgm" + output), 2, "right");
  expect_complaint(run("inspect road/left.png road/left.png" + output), 2, "same");
  expect_complaint(run("inspect road/right.png road/left.png" + output), 2, "left and right look swapped");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(InspectCommand, RejectsInvalidCalibration) {
  make_road();
  const auto complaint = [&](const std::string& figures, const std::string& part) {
    write_text(folder_ / "bad.yaml", figures);
    expect_complaint(inspect("--calibration bad.yaml"), 2, part);
    expect_complaint(inspect("--calibration bad.yaml"), 2, "bad.yaml");
  };
  const std::string centre = "cx_px: 159.5\ncy_px: 89.5\n";
  const std::string size = "width: 320\nheight: 180\n";
  complaint("focal_px: .nan\nbaseline_m: 0.12\n" + centre + size, "nan");
  complaint("focal_px: 175\nbaseline_m: 0\n" + centre + size, "0");
  complaint("focal_px: 175\nbaseline_m: 60\n" + centre + size, "60");
  complaint("focal_px: 3\nbaseline_m: 0.12\n" + centre + size, "3");
  complaint("focal_px: 175\nbaseline_m: 0.12\n" + centre + "width: 640\nheight: 360\n", "640");
  complaint("what: ever\n", "");
  expect_complaint(inspect("--calibration absent.yaml"), 2, "absent.yaml");
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(InspectCommand, TakesRosPairOfTwoFiles) {
  make_road();
  const auto camera = [](const std::string& tx) {
    return "image_width: 320\nimage_height: 180\ncamera_name: camera\n"
           "camera_matrix: {rows: 3, cols: 3, data: [175, 0, 159.5, 0, 175, 89.5, 0, 0, 1]}\n"
           "distortion_model: plumb_bob\n"
           "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n"
           "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
           "projection_matrix: {rows: 3, cols: 4, data: [175, 0, 159.5, " +
           tx + ", 0, 175, 89.5, 0, 0, 0, 1, 0]}\n";
  };
  write_text(folder_ / "l.yaml", camera("0"));
  write_text(folder_ / "r.yaml", camera("-21"));
  for (const std::string files : {"--calibration l.yaml r.yaml", "--calibration l.yaml --calibration r.yaml"}) {
    const Outcome outcome = inspect(files + " --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NEAR(nlohmann::json::parse(outcome.out)["calibration"]["baseline_m"].get<double>(), 0.12, 1e-9);
  }
}

TEST_F(InspectCommand, RejectsUnwritableOutputFolder) {
  make_road();
  write_text(folder_ / "file", "in the way");
  const Outcome outcome = run("inspect road/left.png road/right.png --output file/result");
  expect_complaint(outcome, 2, "file");
  EXPECT_EQ(read_text(folder_ / "file"), "in the way");
}

TEST_F(InspectCommand, KeepsInputsInOutputFolder) {
  make_road();
  fs::copy(folder_ / "road/left.png", folder_ / "road/disparity.png");
  fs::copy(folder_ / "road/right.png", folder_ / "road/overlay.png");
  const std::string before = read_text(folder_ / "road/disparity.png");
  const auto names = names_in(folder_ / "road");
  expect_complaint(run("inspect road/disparity.png road/overlay.png --output road"), 2, "would be overwritten");
  EXPECT_EQ(read_text(folder_ / "road/disparity.png"), before);
  EXPECT_EQ(names_in(folder_ / "road"), names);
  EXPECT_EQ(run("inspect road/left.png road/right.png --output road --quiet").exit_code, 0) << "other names";
}

TEST_F(InspectCommand, KeepsMaskInOutputFolder) {
  make_road();
  const std::vector<std::uint8_t> white(std::size_t{320} * 180, 255);
  const Frame mask{white, 320, 180};
  fs::create_directories(folder_ / "result");
  write("result/overlay.png", io::encode_png(mask.view()));
  const std::string before = read_text(folder_ / "result/overlay.png");
  expect_complaint(inspect("--mask result/overlay.png"), 2, "would be overwritten");
  EXPECT_EQ(read_text(folder_ / "result/overlay.png"), before);
}

TEST_F(InspectCommand, MaskWithoutWhiteIsRefused) {
  make_road();
  Frame mask{std::vector<std::uint8_t>(std::size_t{320} * 180, 0), 320, 180};
  std::fill_n(mask.bytes.begin(), 1000, std::uint8_t{1});
  write("mask.png", io::encode_png(mask.view()));
  expect_complaint(inspect("--mask mask.png"), 2, "mask.png: the mask has no white pixel (255)");
  std::fill_n(mask.bytes.begin(), 1000, std::uint8_t{0});
  write("mask.png", io::encode_png(mask.view()));
  EXPECT_EQ(inspect("--mask mask.png --quiet").exit_code, 0) << "nothing is left out";
}

TEST_F(InspectCommand, OptionsOfRecordingsAreRefused) {
  make_road();
  for (const std::string option : {"--rate 5", "--topics a,b", "--layout top-bottom", "--max-time-difference 3",
                                   "--mount-yaw 3", "--track-offset 5", "--track-offset-sd 1"}) {
    expect_complaint(inspect(option), 2, option.substr(0, option.find(' ')) + " is for recordings only");
  }
}

TEST_F(InspectCommand, SummaryNamesOnlyWhatWasWritten) {
  make_road();
  const Outcome disparity = inspect("--write disparity");
  ASSERT_EQ(disparity.exit_code, 0) << disparity.err;
  EXPECT_NE(disparity.out.find("result/disparity_color.png"), std::string::npos);
  for (const char* name : {"report.html", "overlay.png", "sheet.png", "sigma_color.png"}) {
    EXPECT_EQ(disparity.out.find(name), std::string::npos) << name;
  }
  expect_complaint(inspect("--write cloud"), 2, "--write cloud needs --calibration");
}

TEST_F(InspectCommand, DamageIsNotWrittenIntoItsResults) {
  make_road();
  ASSERT_EQ(inspect().exit_code, 0);
  expect_complaint(run("damage result/transformed.tiff --output result"), 2, "results of a pair");
}

TEST_F(InspectCommand, InterruptedLeavesNoFiles) {
  make_road();
  std::set<std::string> without_clouds = result_files;
  for (const char* cloud : {"cloud.ply", "road_cloud.ply"}) without_clouds.erase(cloud);
  for (const char* delay : {"0.05", "0.1", "0.2", "0.3", "0.4", "0.5", "0.7", "1"}) {
    for (const char* signal : {"INT", "TERM"}) {
      // A child of a script ignores INT unless it is told not to. Without --foreground `timeout` sends the signal
      // twice.
      run("inspect road/left.png road/right.png --output result --preset fast",
          std::string("env --default-signal=INT timeout --foreground -s ") + signal + " " + delay);
      const fs::path result = folder_ / "result";
      if (fs::exists(result) && !fs::is_empty(result)) {
        EXPECT_EQ(names_in(result), without_clouds) << "finished";
      }
      fs::remove_all(result);
    }
  }
}

TEST_F(InspectCommand, FullDiskLeavesNoFiles) {
  make_road();
  const auto before = names_in(folder_);
  // A limit on the size of files makes writes fail as a full disk does.
  for (const char* limit : {"trap '' XFSZ; ulimit -f 8;", "ulimit -f 8;"}) {
    expect_complaint(run("inspect road/left.png road/right.png --output result", limit), 1, "");
    EXPECT_EQ(names_in(folder_), before) << limit;
  }
}

TEST_F(InspectCommand, FullDiskKeepsEarlierResult) {
  make_road();
  ASSERT_EQ(inspect("--quiet").exit_code, 0);
  const std::string earlier = read_text(folder_ / "result/result.json");
  const auto names = names_in(folder_ / "result");
  run("inspect road/left.png road/right.png --output result", "trap '' XFSZ; ulimit -f 8;");
  EXPECT_EQ(names_in(folder_ / "result"), names);
  EXPECT_EQ(read_text(folder_ / "result/result.json"), earlier);
}

TEST_F(InspectCommand, TakesFileNamesThatAreNotUtf8) {
  make_road();
  fs::copy_file(folder_ / "road/left.png", folder_ / "left\xff.png");
  const Outcome outcome = run("inspect 'left\xff.png' road/right.png --output result --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(nlohmann::json::accept(outcome.out));
}

/// The 8-bit image as 16-bit PGM of a 10-bit camera.
std::string ten_bit_pgm(const Frame& frame) {
  std::string text = "P5 " + std::to_string(frame.width) + " " + std::to_string(frame.height) + " 65535\n";
  for (const std::uint8_t grey : frame.bytes) {
    const int value = grey * 1023 / 255;
    text += static_cast<char>(value >> 8);
    text += static_cast<char>(value & 255);
  }
  return text;
}

/// `count` rows of the 8-bit image from row `first` on, as PGM.
std::string pgm_of_rows(const Frame& frame, int first, int count) {
  const auto row = static_cast<std::ptrdiff_t>(frame.width);
  return "P5 " + std::to_string(frame.width) + " " + std::to_string(count) + " 255\n" +
         std::string(frame.bytes.begin() + first * row, frame.bytes.begin() + (first + count) * row);
}

// The right image without its last rows, beside the left one without its first: what is in row v of the left one is
// three rows lower in the right one.
TEST_F(InspectCommand, TellsWhichMisalignmentWasUndone) {
  constexpr int offset = 3;
  make_road();
  const auto left = io::read_frame((folder_ / "road/left.png").string());
  const auto right = io::read_frame((folder_ / "road/right.png").string());
  write_text(folder_ / "left.pgm", pgm_of_rows(left, offset, left.height - offset));
  write_text(folder_ / "right.pgm", pgm_of_rows(right, 0, right.height - offset));
  ASSERT_EQ(run("inspect left.pgm right.pgm --output result").exit_code, 0);
  const auto undone = json_file("result/result.json")["rows"]["undone"];
  EXPECT_NEAR(undone["rows_px"].get<double>(), offset, 0.05);
  EXPECT_NEAR(undone["turn_rad"].get<double>(), 0, 2e-4);
  EXPECT_NEAR(undone["row_scale"].get<double>(), 0, 1e-3);
}

TEST_F(InspectCommand, FindsWhiteLevelUnlessGiven) {
  make_road();
  for (const std::string side : {"left", "right"}) {
    const auto frame = io::read_frame((folder_ / "road" / (side + ".png")).string());
    write_text(folder_ / (side + ".pgm"), ten_bit_pgm(frame));
  }
  ASSERT_EQ(run("inspect left.pgm right.pgm --output result").exit_code, 0);
  EXPECT_EQ(json_file("result/result.json")["options"]["white_level"], 1023);
  ASSERT_EQ(run("inspect left.pgm right.pgm --output result --set white_level=2000").exit_code, 0);
  EXPECT_EQ(json_file("result/result.json")["options"]["white_level"], 2000);
}

}  // namespace
}  // namespace roadstereo

// `limits` from outside: table, verdicts, figure and JSON.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "roadstereo/io/image_file.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

class LimitsCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("rig.yaml", "focal_px: 500\ncx_px: 319.5\ncy_px: 179.5\nbaseline_m: 0.12\nwidth: 640\nheight: 360\n");
    write("K.txt", "500 0 319.5 0 500 179.5 0 0 1\n0.12\n");
  }

  Outcome run(const std::string& arguments) const { return CommandTest::run("limits " + arguments); }
  using CommandTest::write;
};

TEST_F(LimitsCommand, PrintsTableAndDrawsFigure) {
  const Outcome outcome = run("--calibration rig.yaml --height 2 --figure limits.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("69.0"), std::string::npos) << outcome.out;  // 2 m / 29
  EXPECT_NE(outcome.out.find("13 mm cannot be resolved anywhere in the image"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("50 mm can be resolved in the whole image"), std::string::npos) << outcome.out;
  EXPECT_GT(io::read_frame((folder_ / "limits.png").string()).width, 640);
}

TEST_F(LimitsCommand, JsonMatchesClosedForm) {
  const Outcome outcome =
      run("--calibration K.txt --size 640x360 --height 3 --pitch 45 --noise-px 0.04 --rows 3 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto document = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(document["rows"].size(), 3U);
  const double z = 3 * std::numbers::sqrt2;  // of the middle row
  EXPECT_NEAR(document["rows"][1]["row_px"], 179.5, 1e-9);
  EXPECT_NEAR(document["rows"][1]["disparity_px"], 60 / z, 1e-6);
  EXPECT_NEAR(document["rows"][1]["std_error_mm"], 1000 * z * z / 60 * 0.05 / std::numbers::sqrt2, 1e-6);
  ASSERT_EQ(document["astm"].size(), 3U);
  // h²/0.05 + h = 60 · sin 45° / 0.25
  const double h = document["astm"][2]["up_to_height_m"];
  EXPECT_NEAR(h * h / 0.05 + h, 60 * std::numbers::sqrt2 / 2 / 0.25, 1e-6);
}

TEST_F(LimitsCommand, FocalLengthAndBaselineAreARig) {
  const Outcome file = run("--calibration K.txt --size 640x360 --height 2 --json");
  const Outcome rig = run("--focal-px 500 --baseline-m 0.12 --size 640x360 --height 2 --json");
  ASSERT_EQ(rig.exit_code, 0) << rig.err;
  EXPECT_EQ(rig.out, file.out);
  expect_complaint(run("--focal-px 500 --size 640x360 --height 2"), "--baseline-m");
  expect_complaint(run("--focal-px 500 --baseline-m 0.12 --height 2"), "--size");
  expect_complaint(run("--calibration K.txt --focal-px 500 --baseline-m 0.12 --size 640x360 --height 2"), "--focal-px");
}

/// Lenses that hardly distort: almost the rectified rig.
TEST_F(LimitsCommand, RawCamerasAreRectified) {
  const std::string k = ": [500, 0, 319.5, 0, 500, 179.5, 0, 0, 1]\n", d = ": [0.0001, 0, 0, 0, 0]\n";
  const std::string raw =
      "%YAML:1.0\n---\nK1" + k + "D1" + d + "K2" + k + "D2" + d + "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.12, 0, 0]\n";
  write("raw.yml", raw + "image_width: 640\nimage_height: 360\n");
  write("sizeless.yml", raw);
  const auto depth = [&](const std::string& rig) {
    const Outcome outcome = run("--calibration " + rig + " --height 2 --rows 3 --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out)["rows"][1]["resolvable_depth_mm"].get<double>();
  };
  const double expected = depth("rig.yaml");
  EXPECT_NEAR(depth("raw.yml"), expected, 0.03 * expected);
  EXPECT_NEAR(depth("sizeless.yml --size 640x360"), expected, 0.03 * expected);
  expect_complaint(run("--calibration sizeless.yml --height 2"), "--size WIDTHxHEIGHT");
}

TEST_F(LimitsCommand, HostileCalibrationIsOneSentence) {
  const std::string begin = "%YAML:1.0\n---\n";
  write("deep.yaml", begin + "K1: " + std::string(40'000, '['));
  write("hang.yaml", begin + " x:\\\nD0:-\nL");
  write("length.yaml", std::string(" \xff:5\n :opencv-matrix"));
  for (const std::string name : {"deep.yaml", "hang.yaml", "length.yaml"}) {
    expect_complaint(CommandTest::run("limits --height 2 --calibration " + name, "ulimit -t 20; ulimit -s 256;"), name);
  }
}

TEST_F(LimitsCommand, RejectsBadInput) {
  expect_complaint(run("--calibration rig.yaml --height 0"), "--height");
  expect_complaint(run("--calibration rig.yaml --height -2"), "--height");
  expect_complaint(run("--calibration rig.yaml --height 2 --pitch 91"), "--pitch");
  expect_complaint(run("--calibration rig.yaml --height 2 --pitch -45"), "not in view");
  expect_complaint(run("--calibration rig.yaml --height 2 --noise-px -1"), "--noise-px");
  expect_complaint(run("--calibration none.yaml --height 2"), "none.yaml");
  expect_complaint(run("--calibration K.txt --height 2"), "--size");
  expect_complaint(run("--calibration rig.yaml --height 2 --size 64"), "64");
  expect_complaint(run("--calibration rig.yaml --height 2 --size 320x180"), "rig.yaml");
  expect_complaint(run("--calibration rig.yaml"), "--height");
  expect_complaint(run("--height 2"), "--calibration");
}

}  // namespace
}  // namespace roadstereo

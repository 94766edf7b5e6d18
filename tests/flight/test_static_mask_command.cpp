// A bonnet in a recording: ignored from the frame on that shows it, and the same after a run that was stopped.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/synth.hpp"
#include "synth/lens_cover.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

constexpr int bonnet_frames = 44, judged_frame = 39;

class StaticMaskCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    scene_ = synth::named_scene("uav");
    scene_.rig.focal_px *= 256.0 / scene_.rig.width;
    scene_.rig.width = 256;
    scene_.rig.height = 144;
    scene_.supersampling = 1;
    scene_.degradation.bonnet_share = 0.25;
    fs::create_directories(folder_ / "flight/left");
    fs::create_directories(folder_ / "flight/right");
    for (int i = 0; i < bonnet_frames; ++i) {
      const synth::SyntheticPair pair = synth::render(synth::flight_frame(scene_, {}, i), 1);
      const std::string name = std::to_string(100 + i) + ".png";
      write("flight/left/" + name, io::encode_png(pair.left.view()));
      write("flight/right/" + name, io::encode_png(pair.right.view()));
      if (i > 0) continue;
      const StereoCalibration& rig = pair.calibration;
      write("rig.yaml", "focal_px: " + std::to_string(rig.focal_px) + "\ncx_px: " + std::to_string(rig.cx_px) +
                            "\ncy_px: " + std::to_string(rig.cy_px) + "\nbaseline_m: 0.12\nwidth: 256\nheight: 144\n");
    }
  }

  Outcome inspect(const std::string& output, const std::string& options = "") const {
    return run("inspect flight --calibration rig.yaml --rate 10 --write disparity --output " + output + " " + options);
  }

  /// frames.csv without what a clock tells.
  std::vector<std::string> figures(const std::string& output) const {
    std::vector<std::string> rows;
    std::ifstream file(folder_ / output / "frames.csv");
    for (std::string row; std::getline(file, row);) {
      std::string figures;
      std::istringstream cells(row);
      int column = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++column) {
        if (column != 21 && column != 22) figures += cell + ",";  // matching_ms, damage_ms
      }
      rows.push_back(figures);
    }
    return rows;
  }

  void expect_same(const std::string& output, const std::string& expected) const {
    EXPECT_EQ(figures(output), figures(expected));
    for (const char* name : {"static_mask.png", "damages.csv", "sightings.csv", "pose.csv"}) {
      EXPECT_TRUE(read_text(folder_ / output / name) == read_text(folder_ / expected / name)) << name << " differs";
    }
    for (int i = 0; i < bonnet_frames; ++i) {
      const std::string name = "disparity/0000" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".tiff";
      const std::string found = read_text(folder_ / output / name);
      EXPECT_FALSE(found.empty()) << name;
      EXPECT_TRUE(found == read_text(folder_ / expected / name)) << name << " differs";
    }
  }

  synth::Scene scene_;
};

TEST_F(StaticMaskCommand, BonnetIsIgnoredFromFortiethFrameOn) {
  const Outcome outcome = inspect("out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("% of the picture never moves (bonnet?) and is ignored from frame 39 on"),
            std::string::npos)
      << outcome.out;
  const nlohmann::json summary = json_file("out/summary.json");
  ASSERT_TRUE(summary["static_mask"].is_object());
  EXPECT_EQ(summary["static_mask"]["from_frame"], judged_frame);
  EXPECT_TRUE(summary["static_mask"]["applied"].get<bool>());
  EXPECT_EQ(summary["inputs"]["mask"], "static_mask.png");
  const Frame mask = io::read_frame((folder_ / "out/static_mask.png").string());
  const Image<float> before = io::read_disparity((folder_ / "out/disparity/000038.tiff").string());
  const Image<float> after = io::read_disparity((folder_ / "out/disparity/000039.tiff").string());
  int bonnet = 0, masked_bonnet = 0, masked = 0, valid_before = 0;
  for (int v = 0; v < 144; ++v) {
    for (int u = 0; u < 256; ++u) {
      const bool is_masked = mask.bytes[static_cast<std::size_t>(256 * v + u)] != 0;
      const bool is_bonnet = synth::is_bonnet(scene_, 0, u, v);
      bonnet += is_bonnet ? 1 : 0;
      masked_bonnet += is_bonnet && is_masked ? 1 : 0;
      masked += is_masked ? 1 : 0;
      valid_before += is_masked && !std::isnan(before(u, v)) ? 1 : 0;
      ASSERT_TRUE(!is_masked || std::isnan(after(u, v))) << u << ' ' << v;
    }
  }
  RecordProperty("masked_bonnet", std::to_string(1.0 * masked_bonnet / bonnet));
  EXPECT_GT(masked_bonnet, 0.5 * bonnet);
  EXPECT_LT(masked, 1.6 * bonnet);
  EXPECT_GT(valid_before, masked / 5);
  EXPECT_NEAR(summary["static_mask"]["share"].get<double>(), masked / (256.0 * 144), 1e-9);
  const std::vector<std::string> frames = figures("out");
  for (int i = 0; i < bonnet_frames; ++i) {
    const bool warned = frames[static_cast<std::size_t>(i) + 1].find("static-mask: ") != std::string::npos;
    EXPECT_EQ(warned, i == judged_frame) << i;
  }
  EXPECT_NE(read_text(folder_ / "out/report.html").find("never moves (bonnet?)"), std::string::npos);

  // A run stopped before the mask is known, and after.
  for (const char* last : {"17", "41"}) {
    const std::string output = std::string("stopped") + last;
    ASSERT_EQ(inspect(output, std::string("--to ") + last).exit_code, 0);
    const Outcome resumed = inspect(output, "--resume");
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_same(output, "out");
  }
}

TEST_F(StaticMaskCommand, NothingIsIgnoredWhenNotWanted) {
  ASSERT_EQ(inspect("out", "--no-auto-mask").exit_code, 0);
  EXPECT_TRUE(json_file("out/summary.json")["static_mask"].is_null());
  EXPECT_EQ(json_file("out/summary.json")["inputs"]["mask"], "");
  EXPECT_FALSE(fs::exists(folder_ / "out/static_mask.png"));
  expect_complaint(inspect("out", "--resume"), "--no-auto-mask");
  expect_complaint(run("inspect flight/left/100.png flight/right/100.png --output pair --no-auto-mask"),
                   "--no-auto-mask is for recordings only");
}

TEST_F(StaticMaskCommand, LiveTellsWhatNeverMoves) {
  const Outcome outcome = run("live flight --calibration rig.yaml --rate 10 --max-age 60000 --loop --frames 42 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json summary = nlohmann::json::parse(outcome.out);
  ASSERT_TRUE(summary["static_mask"].is_object()) << outcome.out;
  EXPECT_GT(summary["static_mask"]["share"].get<double>(), 0.15);
  EXPECT_TRUE(summary["static_mask"]["applied"].get<bool>());
}

}  // namespace
}  // namespace roadstereo

// The output folder of `inspect` on a recording: what an earlier flight leaves there, and when it goes.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/pose_graph.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

class FlightFolderCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    const Outcome made = run("synth --scene uav --size 256x144 --frames 3 --flight default --output flight --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  Outcome inspect(const std::string& options) const { return run("inspect flight --output out --quiet " + options); }

  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
      if (entry.is_regular_file()) all[entry.path().string()] = read_text(entry.path());
    }
    return all;
  }
  bool has(const std::string& name) const { return fs::exists(folder_ / "out" / name); }
};

// The size of the frames is known only with the first pair.
TEST_F(FlightFolderCommand, RefusedOptionsKeepEarlierFlight) {
  ASSERT_EQ(inspect("--write disparity,mcap --trajectory").exit_code, 0);
  const auto before = files();
  Frame mask{std::vector<std::uint8_t>(std::size_t{128} * 72, 255), 128, 72};
  write("mask.png", io::encode_png(mask.view()));
  expect_complaint(inspect("--mask mask.png"), "mask.png has 128×72 pixels");
  expect_complaint(inspect("--mask mask.png --write mcap"), "mask.png has 128×72 pixels");
  RigBias bias;
  bias.width = 320;
  bias.height = 180;
  bias.focal_px = 200;
  bias.order = 2;
  bias.frames = 20;
  bias.region_px = {0, 90, 319, 179};
  bias.value_px[3] = 0.1;
  bias.std_error_px[3] = 0.01;
  write("bias.json", io::rig_bias_json(bias));
  expect_complaint(inspect("--rig-bias bias.json"), "320×180");
  expect_complaint(inspect("--mount-yaw 400"), "--mount-yaw is 400; it must be between -360 and 360 degrees");
  EXPECT_TRUE(files() == before);
  ASSERT_EQ(inspect("").exit_code, 0);
  EXPECT_FALSE(has("flight.mcap"));
  EXPECT_FALSE(has("disparity/000000.tiff"));
  EXPECT_FALSE(has("trajectory.csv"));
}

TEST_F(FlightFolderCommand, ResumeRemovesWhatItDoesNotWrite) {
  write("track.csv", std::string("time,lat,lon\n0,48.5,9.05\n1,48.5001,9.05\n"));
  const Outcome outcome = inspect("--track track.csv --candidates --map");
  ASSERT_TRUE(has("map/map.json")) << outcome.err;
  ASSERT_TRUE(has("candidates.geojson"));
  write("out/rig_bias.json", std::string("{}"));
  write("out/map/notes.txt", std::string("own"));
  ASSERT_EQ(inspect("--track track.csv --resume").exit_code, 0);
  EXPECT_FALSE(has("candidates.geojson"));
  EXPECT_FALSE(has("rig_bias.json"));
  EXPECT_FALSE(has("trajectory_kitti.txt"));
  EXPECT_FALSE(has("map/map.json"));
  EXPECT_FALSE(has("map/height.tif"));
  EXPECT_TRUE(has("map/notes.txt"));
  EXPECT_TRUE(has("damages.geojson"));
  EXPECT_TRUE(has("flight.gpkg"));
}

TEST_F(FlightFolderCommand, ReportOfThisFolderHasItsName) {
  const Outcome outcome = run("inspect . --output ../out --quiet", "cd flight &&");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(read_text(folder_ / "out/report.html").find("<title>flight"), std::string::npos);
}

}  // namespace
}  // namespace roadstereo

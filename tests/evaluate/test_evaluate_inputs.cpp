// Inputs that an experiment cannot use: wrong settings, files that do not belong together, options of another input.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/require_size.hpp"
#include "evaluate/kitti_frames.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/label_image.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cli/command_test.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;

class EvaluateInputs : public CommandTest {
 protected:
  static constexpr int width = 320, height = 180;

  Outcome run(const std::string& arguments) const { return CommandTest::run("evaluate " + arguments); }

  void render(const std::string& arguments) const {
    ASSERT_EQ(CommandTest::run("synth --scene demo --size 320x180 --quiet " + arguments).exit_code, 0);
  }

  /// A recording of three frames with their poses.
  void render_drive() const {
    render("--frames 3 --output drive");
    fs::copy_file(folder_ / "drive/trajectory_kitti.txt", folder_ / "drive/poses.txt");
  }

  /// A frame of KITTI with a mask of its road.
  void write_kitti(int columns, const ImageSize& truth, const ImageSize& mask) const {
    for (const char* part : {"image_2", "image_3", "disp_noc_0", "road"}) fs::create_directories(folder_ / "k" / part);
    for (const char* view : {"k/image_2/000001_10.png", "k/image_3/000001_10.png"}) {
      write(view, grey_png({columns, height}));
    }
    write("k/disp_noc_0/000001_10.png", io::encode_kitti_png(Image<float>(truth.width, truth.height, 20.0F)));
    write("k/road/000001_10.png", grey_png(mask));
  }

  /// A folder of one scene, rendered beforehand into `scene`.
  void write_scene(const std::string& kind, const ImageSize& truth) const {
    const auto pixels = std::size_t{width} * height;
    fs::create_directories(folder_ / "scenes/one");
    for (const char* name : {"left.png", "right.png", "calibration.yaml"}) {
      fs::copy_file(folder_ / "scene" / name, folder_ / "scenes/one" / name, fs::copy_options::overwrite_existing);
    }
    Image<std::uint16_t> damage(width, height, 0);
    for (int v = 100; v < 120; ++v) std::fill_n(damage.row(v) + 100, 40, std::uint16_t{1});
    write("scenes/one/disparity.tiff", io::encode_float_tiff(Image<float>(truth.width, truth.height, 20.0F)));
    write("scenes/one/region.png", io::encode_png(Frame{std::vector<std::uint8_t>(pixels, 1), width, height}.view()));
    write("scenes/one/occ.png", grey_png({width, height}));
    write("scenes/one/damage.png", io::encode_label_png(damage));
    write("scenes/one/truth.json", R"({"height_m": 1.5, "damages": [{"label": 1, "kind": ")" + kind +
                                       R"(", "max_depth_m": 5, "area_m2": 0.2, "volume_m3": 0.01}]})");
  }

  static std::vector<std::uint8_t> grey_png(const ImageSize& size) {
    const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    return io::encode_png(Frame{std::vector<std::uint8_t>(pixels, 255), size.width, size.height}.view());
  }
};

TEST_F(EvaluateInputs, WrongSettingsAreNoRejectedPairs) {
  expect_complaint(run("robustness --scenes 1 --set matcher.bogus=1"), "matcher.bogus");
  expect_complaint(run("faults --only none --pictures 1 --set matcher.block_radius=9999"), "block_radius");
  render_drive();
  expect_complaint(run("robustness drive --scenes 0 --set matcher.block_radius=9999"), "block_radius");
}

TEST_F(EvaluateInputs, SourcesOfOneNameShareTheirFrames) {
  render("--output scene");
  write_scene("pothole", {width, height});
  for (const char* parent : {"a/x", "b/x"}) {
    fs::create_directories(folder_ / parent);
    fs::copy(folder_ / "scenes", folder_ / parent / "scenes", fs::copy_options::recursive);
  }
  ASSERT_EQ(run("robustness a b --scenes 0 --json robustness.json").exit_code, 0);
  EXPECT_EQ(json_file("robustness.json")["frames"]["x/scenes"].size(), 2U);
}

TEST_F(EvaluateInputs, DamageOfLostRoadIsMissed) {
  render("--noise 100 --exposure 0.05 --output scene");
  write_scene("pothole", {width, height});
  ASSERT_EQ(run("damage scenes --json score.json").exit_code, 0);
  const auto row = json_file("score.json")["detection"][0];
  EXPECT_EQ(row["deeper_than_3_std_errors"], 1) << row;
  EXPECT_EQ(row["recall"], 0) << row;
}

TEST_F(EvaluateInputs, KindsOfDamageAreKnown) {
  render("--output scene");
  write_scene("alligator", {width, height});
  ASSERT_EQ(run("damage scenes --json score.json").exit_code, 0);
  EXPECT_EQ(json_file("score.json")["detection"][0]["kind"], "crack");
  write_scene("ditch", {width, height});
  expect_complaint(run("damage scenes"), "truth.json: the kind of damage 1 is ditch");
}

TEST_F(EvaluateInputs, FilesOfOneFrameHaveOneSize) {
  write_kitti(width, {width, height - 1}, {width, height});
  expect_complaint(run("damage k"), "disp_noc_0/000001_10.png has 320×179 pixels");
  write_kitti(width, {width, height}, {width - 1, height});
  expect_complaint(run("damage k"), "road/000001_10.png has 319×180 pixels");
  render("--output scene");
  write_scene("pothole", {width + 1, height});
  expect_complaint(run("damage scenes"), "disparity.tiff has 321×180 pixels");
  expect_complaint(run("damage absent"), "absent is not a folder");
}

TEST_F(EvaluateInputs, MasksMustBeOfTheFrames) {
  write_kitti(width, {width, height}, {width, height});
  fs::create_directories(folder_ / "masks");
  write("masks/other.png", grey_png({width, height}));
  expect_complaint(run("kitti k --road-masks masks"), "masks has the road of no frame");
  expect_complaint(run("paper k --road-masks masks --output page"), "masks has the road of no frame");
}

TEST_F(EvaluateInputs, KittiWithoutCalibrationHasThatOfItsDay) {
  write_kitti(1241, {1241, height}, {1241, height});
  const auto frame = cli::read_kitti_frame(cli::find_kitti_frames((folder_ / "k").string(), "").front());
  EXPECT_NEAR(frame.pair.calibration->focal_px, 718.86, 0.01);
  EXPECT_NEAR(frame.pair.calibration->cx_px, 607.19, 0.01);
  EXPECT_NEAR(frame.pair.calibration->cy_px, 185.22, 0.01);
}

TEST_F(EvaluateInputs, OdometryOfDarkSamplesIsThatOfBrightOnes) {
  render_drive();
  ASSERT_EQ(run("odometry --calibration drive/calibration.yaml drive --peers flow --json bright.json").exit_code, 0);
  // The same grey levels in 10 of 16 bits.
  for (const char* view : {"left", "right"}) {
    for (const auto& file : fs::directory_iterator(folder_ / "drive" / view)) {
      GreyImage grey;
      to_grey(io::read_frame(file.path().string()).view(), 0, grey);
      Image<std::uint16_t> deep(grey.width(), grey.height());
      std::transform(grey.row(0), grey.row(0) + grey.pixels(), deep.row(0),
                     [](std::int16_t level) { return static_cast<std::uint16_t>(level / (grey_scale / 4)); });
      write(fs::relative(file.path(), folder_).string(), io::encode_label_png(deep));
    }
  }
  ASSERT_EQ(run("odometry drive --peers flow --json dark.json").exit_code, 0);
  const auto bright = json_file("bright.json")["rows"], dark = json_file("dark.json")["rows"];
  EXPECT_NEAR(dark[0]["link_median_px"].get<double>(), bright[0]["link_median_px"].get<double>(), 0.02);
}

TEST_F(EvaluateInputs, RecordingHasAsManyPairsAsPoses) {
  render_drive();
  render("--frames 4 --output four");
  fs::copy_file(folder_ / "drive/trajectory_kitti.txt", folder_ / "four/poses.txt");
  expect_complaint(run("odometry four --peers flow"), "more pairs than the 3 poses");
}

TEST_F(EvaluateInputs, OptionsOfAnotherInputAreRefused) {
  for (const char* arguments :
       {"damage . --scenes 3", "damage . --ruts", "damage --write-pairs pairs --json score.json",
        "damage --write-pairs pairs --preset fast", "damage --write-pairs pairs .", "odometry . --frames 5",
        "odometry . --flight loop=300", "odometry --flight loop=300 --calibration c.yaml",
        "roll --no-pairs --set threads=1", "synth --write-pairs pairs --set threads=1", "scan . --labelled 5",
        "scan a.ply b.ply --methods default"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_TRUE(outcome.err.find("exclude") != std::string::npos || outcome.err.find("requires") != std::string::npos ||
                outcome.err.find("must not be given") != std::string::npos)
        << arguments << ": " << outcome.err;
  }
}

}  // namespace

// `damage` from outside: maps in, files out.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/ply_read.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/point_cloud.hpp"
#include "tests/cli/command_test.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

Image<float> scaled(const Image<float>& map, float factor, float offset) {
  Image<float> result = map;
  std::transform(map.row(0), map.row(0) + map.pixels(), result.row(0),
                 [&](float value) { return factor * value + offset; });
  return result;
}

/// Rows from the last to the first, little endian.
std::vector<std::uint8_t> encode_pfm(const Image<float>& map) {
  const std::string header = "Pf\n" + std::to_string(map.width()) + " " + std::to_string(map.height()) + "\n-1.0\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  for (int v = map.height() - 1; v >= 0; --v) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(map.row(v));
    bytes.insert(bytes.end(), row, row + sizeof(float) * static_cast<std::size_t>(map.width()));
  }
  return bytes;
}

std::string calibration_text(const StereoCalibration& rig) {
  return "focal_px: " + std::to_string(rig.focal_px) + "\ncx_px: " + std::to_string(rig.cx_px) +
         "\ncy_px: " + std::to_string(rig.cy_px) + "\nbaseline_m: " + std::to_string(rig.baseline_m) +
         "\nwidth: " + std::to_string(rig.width) + "\nheight: " + std::to_string(rig.height) + "\n";
}

class DamageCommand : public CommandTest {
 protected:
  void write_damaged() const {
    write("map.tiff", io::encode_float_tiff(damaged().transformed));
    write("disparity.tiff", io::encode_float_tiff(damaged().disparity));
    write("left.png", io::encode_png(damaged().pair.left.view()));
    write("rig.yaml", calibration_text(damaged().pair.calibration));
  }

  /// Runs `damage` and returns damages.json.
  nlohmann::json damages_of(const std::string& arguments) const {
    const Outcome outcome = run("damage " + arguments + " --output out");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(read_text(folder_ / "out" / "damages.json"));
  }
  std::vector<std::uint8_t> ids() const {
    return io::read_frame((folder_ / "out" / "damage.png").string()).bytes;  // 16 bit
  }

  /// Exit code 2, nothing on stdout, one sentence that names the part, and no results.
  void refuse(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Outcome outcome = run("damage " + arguments + " --output refused");
    for (const std::string& part : parts) expect_complaint(outcome, part);
    EXPECT_FALSE(fs::exists(folder_ / "refused" / "damages.json"));
  }
};

double share_of_different(const std::vector<std::uint8_t>& one, const std::vector<std::uint8_t>& other) {
  if (one.size() != other.size() || one.empty()) return 1;
  std::size_t different = 0;
  for (std::size_t k = 0; k < one.size(); ++k) different += one[k] != other[k] ? 1U : 0U;
  return static_cast<double>(different) / static_cast<double>(one.size());
}

TEST_F(DamageCommand, FileFormatHasNoEffect) {
  write_damaged();
  write("map.pfm", encode_pfm(damaged().transformed));
  write("map.png", io::encode_kitti_png(scaled(damaged().transformed, 6, 10)));  // its own unit
  const auto of_tiff = damages_of("map.tiff");
  const std::vector<std::uint8_t> expected = ids();
  EXPECT_EQ(of_tiff["damages"].size(), 2U);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "overlay.png"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "report.html"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "damages.csv"));
  EXPECT_EQ(damages_of("map.pfm")["damages"], of_tiff["damages"]);
  EXPECT_EQ(ids(), expected);
  damages_of("map.png");
  EXPECT_LT(share_of_different(ids(), expected), 1e-4);
}

TEST_F(DamageCommand, DisparityAndCalibrationMakeFiguresMetric) {
  write_damaged();
  write("map.png", io::encode_kitti_png(scaled(damaged().transformed, 6, 10)));
  const std::string rig = " --disparity disparity.tiff --calibration rig.yaml --image left.png";
  const auto of_tiff = damages_of("map.tiff" + rig);
  const auto of_png = damages_of("map.png" + rig);
  ASSERT_EQ(of_tiff["damages"].size(), 2U);
  ASSERT_EQ(of_png["damages"].size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& known = damaged().pair.damages[k];  // the pothole is deeper than the bump is high
    const auto& one = of_tiff["damages"][k];
    const auto& other = of_png["damages"][k];
    const double depth = one["max_depth_m"];
    EXPECT_NEAR(depth, known.depth_m, 0.05 * known.depth_m);
    EXPECT_NEAR(other["max_depth_m"].get<double>(), depth, 0.01 * depth);
    const double area = one["area_m2"];
    EXPECT_NEAR(area, known.area_m2, 0.1 * known.area_m2);
    EXPECT_NEAR(other["area_m2"].get<double>(), area, 0.01 * area);
  }
}

/// The pothole of 60 mm is "high" by its diameter in ASTM D6433, "low" between 40 and 100 mm of the file.
TEST_F(DamageCommand, SeverityFileReplacesTables) {
  write_damaged();
  const std::string map = "map.tiff --disparity disparity.tiff --calibration rig.yaml --severity ";
  const auto standard = damages_of(map + "d6433")["damages"][0];
  EXPECT_EQ(standard["distress"], "pothole");
  EXPECT_EQ(standard["severity"], standard["diameter_m"].get<double>() >= 0.45 ? "high" : "medium");
  write("own.yaml", std::string("name: own\npothole: {unit: m2, depth_mm: [40, 100], severity: [low, high]}\n"));
  const auto own = damages_of(map + "own.yaml")["damages"][0];
  EXPECT_EQ(own["severity"], "low");
  EXPECT_EQ(own["unit"], "m2");
  EXPECT_EQ(own["quantity"], own["area_m2"]);
  const auto fails = [&](const std::string& text, const std::string& part) {
    write("own.yaml", text);
    expect_complaint(run("damage " + map + "own.yaml --output out"), part);
  };
  fails("hole: {unit: m2}\n", "hole");
  fails("pothole: {unit: feet}\n", "feet");
  fails("pothole: {unit: m2, depth_mm: [40, 30], severity: [low, high]}\n", "ascend");
  fails("pothole: {unit: m2, depth_mm: [40], severity: [severe]}\n", "severe");
  fails("pothole: {unit: m2, depth_mm: [40], severity: [low]}\npothole: {unit: m2}\n", "pothole is given twice");
  fails("name: [a, b]\n", "name has the wrong value");
  fails("pothole: {unit: m2, depth_mm: [deep], severity: [low]}\n", "depth_mm has the wrong value [deep]");
  fails("pothole: {depth_mm: [40], severity: [low]}\n", "unit is missing");
  fails("pothole: {unit: m2, depth_mm: [40], severity: [low], aera_of_one_m2: 1}\n", "aera_of_one_m2");
  fails("pothole: {unit: m2, depth_mm: deep}\n", "depth_mm");
  fails("[", "own.yaml");
}

TEST_F(DamageCommand, IntactRoadSucceeds) {
  const ExactMaps intact(intact_scene());
  write("map.tiff", io::encode_float_tiff(intact.transformed));
  const Outcome outcome = run("damage map.tiff --output out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("none found"), std::string::npos) << outcome.out;
  EXPECT_EQ(nlohmann::json::parse(read_text(folder_ / "out" / "damages.json"))["damages"].size(), 0U);
}

TEST_F(DamageCommand, AppliesOptions) {
  write_damaged();
  EXPECT_EQ(damages_of("map.tiff --set damage.protrusions=false")["damages"].size(), 1U);
  EXPECT_EQ(damages_of("map.tiff --threads 1 --set damage.protrusions=false --set damage.threshold_sigma=6")["damages"]
                .size(),
            1U);
  const Outcome quiet = run("damage map.tiff --output out --quiet");
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(DamageCommand, RejectsMapsWithoutContent) {
  refuse("missing.tiff", {"missing.tiff"});
  write("eight.png", io::encode_png(damaged().pair.left.view()));
  refuse("eight.png", {"eight.png", "16"});
  write("grey.tiff", io::encode_float_tiff(Image<float>(64, 48, 12.5F)));
  refuse("grey.tiff", {"grey.tiff", "12.5"});
  write("empty.tiff", io::encode_float_tiff(Image<float>(64, 48, truth::nan_value)));
  refuse("empty.tiff", {"empty.tiff", "no valid pixel"});
  write("text.tiff", std::string("not a map"));
  refuse("text.tiff", {"text.tiff"});
}

TEST_F(DamageCommand, RejectsFilesThatDoNotMatch) {
  write_damaged();
  write("small.png", io::encode_png(FrameView{damaged().pair.left.bytes.data(), 320, 180, 640}));
  refuse("map.tiff --image small.png", {"small.png", "320×180", "640×360"});
  write("short.tiff", io::encode_float_tiff(Image<float>(640, 200, 3.0F)));
  refuse("map.tiff --disparity short.tiff", {"short.tiff", "640×200"});
  synth::Scene scene = damaged_scene();
  scene.road.camber = 0;
  scene.road.blobs = {{0.3, 0.8, 0.2, 0.05, 0.2, 0.3, 9}};
  write("other.tiff", io::encode_float_tiff(ExactMaps(scene).disparity));
  refuse("map.tiff --disparity other.tiff", {"other.tiff", "map.tiff", "correlation"});
  write("empty.tiff", io::encode_float_tiff(Image<float>(640, 360, truth::nan_value)));
  refuse("map.tiff --disparity empty.tiff", {"empty.tiff"});
  StereoCalibration rig = damaged().pair.calibration;
  rig.width = 320;
  rig.height = 180;
  write("half.yaml", calibration_text(rig));
  refuse("map.tiff --disparity disparity.tiff --calibration half.yaml", {"half.yaml", "320×180"});
}

TEST_F(DamageCommand, RejectsOptionsOfOtherStages) {
  write_damaged();
  refuse("map.tiff --set matcher.sigma_space=2", {"matcher.sigma_space", "damage."});
  refuse("map.tiff --set damage.colour=red", {"damage.colour"});
  refuse("map.tiff --set damage.threshold_sigma=0", {"threshold_sigma"});
  refuse("map.tiff --threads -1", {"threads"});
}

TEST_F(DamageCommand, InspectWritesDamageAndClouds) {
  ASSERT_EQ(run("synth --scene demo --size 640x360 --output road --quiet").exit_code, 0);
  const Outcome outcome = run("inspect road/left.png road/right.png --calibration road/calibration.yaml --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name :
       {"damages.json", "damages.csv", "damage.png", "overlay.png", "report.html", "cloud.ply", "road_cloud.ply"}) {
    EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
  }
  const std::size_t line = outcome.out.find("damage ");
  ASSERT_NE(line, std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("mm", line), std::string::npos) << outcome.out;
  const auto damages = nlohmann::json::parse(read_text(folder_ / "out" / "damages.json"));
  EXPECT_GE(damages["damages"].size(), 2U);                                 // two potholes
  EXPECT_GE(damages["damages"].size() + damages["candidates"].size(), 3U);  // and a bump; cracks are narrow
  const PointCloud cloud = io::read_ply((folder_ / "out" / "road_cloud.ply").string());
  ASSERT_GT(cloud.points.size(), 100'000U);
  std::vector<float> heights;
  heights.reserve(cloud.points.size());
  for (const auto& point : cloud.points) heights.push_back(std::abs(point[2]));
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  EXPECT_LT(*middle, 0.005);
}

TEST_F(DamageCommand, InspectWithoutCalibrationHasNoClouds) {
  ASSERT_EQ(run("synth --scene demo --size 320x180 --output road --quiet").exit_code, 0);
  const Outcome outcome = run("inspect road/left.png road/right.png --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "out" / "damages.json"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "cloud.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "road_cloud.ply"));
}

}  // namespace
}  // namespace roadstereo

// `roadstereo evaluate scan` from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/point_cloud.hpp"
#include "tests/cli/command_test.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;

class EvaluateScan : public CommandTest {
 protected:
  Outcome run(const std::string& arguments) const { return CommandTest::run("evaluate scan " + arguments); }
  void write(const std::string& name, const PointCloud& cloud) const {
    CommandTest::write(name, io::encode_ply(cloud));
  }
};
using EvaluateScanRealData = EvaluateScan;

/// An unsymmetric hollow on a grid: millimetres with scale 1.
PointCloud hollow(double scale, double step_mm) {
  PointCloud cloud;
  const int count = static_cast<int>(40 / step_mm);
  for (int i = -count; i <= count; ++i) {
    for (int j = -count; j <= count; ++j) {
      const double x = i * step_mm, y = j * step_mm;
      const double z =
          30 * std::exp(-(x * x / 400 + y * y / 900)) + 5 * std::sin(x / 8 + 0.3) * std::cos(y / 12) + x / 9;
      cloud.points.push_back(
          {static_cast<float>(scale * x), static_cast<float>(scale * y), static_cast<float>(scale * z)});
    }
  }
  return cloud;
}

/// Metres against millimetres, turned upside down: (x, y, z) → (x, −y, 1 − z).
TEST_F(EvaluateScan, CloudIsRegisteredToScan) {
  PointCloud cloud = hollow(1e-3, 1);
  for (auto& [x, y, z] : cloud.points) {
    y = -y;
    z = 1 - z;
  }
  write("cloud.ply", cloud);
  write("scan.ply", hollow(1, 0.5));
  const Outcome outcome = run("cloud.ply scan.ply --labelled 8202 --json scan.json --figure scan.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto rows = json_file("scan.json");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LT(rows[0]["rms_mm"], 0.3);  // the grids are 0.5 mm apart
  EXPECT_NEAR(rows[0]["completeness_percent"], 100.0 * 6561 / 8202, 1e-6);
  EXPECT_NEAR(rows[0]["rms_missing_10mm"], std::sqrt(100 * 1641.0 / 8202), 0.02);
  EXPECT_NE(outcome.out.find("RMS mm"), std::string::npos);
  EXPECT_GT(io::read_frame((folder_ / "scan.png").string()).width, 100);
}

TEST_F(EvaluateScan, RejectsBadInput) {
  write("cloud.ply", hollow(1e-3, 1));
  write("scan.ply", hollow(1, 1));
  expect_complaint(run("cloud.ply none.ply"), "none.ply");
  expect_complaint(run("scan.ply cloud.ply"), "--cloud-unit-mm");
  expect_complaint(run("cloud.ply scan.ply --labelled 5"), "labelled");
  expect_complaint(run("cloud.ply scan.ply --cloud-unit-mm 0"), "--cloud-unit-mm");
  expect_complaint(run("nowhere"), "nowhere");
  expect_complaint(run("nowhere --methods default,SGBM"), "nowhere/left is not a folder");
  expect_complaint(run("cloud.ply scan.ply --label cloud.ply"), "--calibration");
  expect_complaint(run(". --scan scan.ply"), "LEFT RIGHT");
  expect_complaint(run(""), "INPUT");
}

TEST_F(EvaluateScan, NamesPairAndMethodWithoutPoints) {
  ASSERT_EQ(CommandTest::run("synth --scene demo --size 320x180 --output scene --quiet").exit_code, 0);
  fs::create_directories(folder_ / "mine");
  CommandTest::write("mine/pair.tiff", io::encode_float_tiff(Image<float>(320, 180, std::nanf(""))));
  write("scan.ply", hollow(1, 2));
  expect_complaint(run("scene/left.png scene/right.png --calibration scene/calibration.yaml --label "
                       "scene/truth_labels.png --scan scan.ply --methods default --maps mine=mine"),
                   "pair, mine: the cloud has 0 points");
}

/// The real potholes. The bounds are regression bounds, a little above what was measured.
TEST_F(EvaluateScanRealData, PotholeMatchesLaserScan) {
  const char* data = std::getenv("ROADSTEREO_DATA");
  const fs::path potholes = fs::path(data == nullptr ? "" : data) / "potholes";
  if (!fs::is_directory(potholes)) GTEST_SKIP() << "no potholes: set ROADSTEREO_DATA";
  const std::string root = potholes.string();
  const Outcome outcome = run("'" + root + "/left/p3_03.png' '" + root + "/right/p3_03.png' --calibration '" + root +
                              "/calibration_p3.yaml' --label '" + root + "/label/p3_03.png' --scan '" + root +
                              "/scan/p3_scan1.ply' --methods SGBM --json scan.json --figure scan.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto rows = json_file("scan.json");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["labelled_pixels"], 21270);
  EXPECT_LT(rows[0]["rms_mm"], 2.0);
  EXPECT_GT(rows[0]["completeness_percent"], 92);
  EXPECT_GT(rows[0]["next_pose_rms_mm"], 1.3 * rows[0]["pose_rms_mm"].get<double>());
}

}  // namespace

// `evaluate damage`: scores against synthetic truth and against labels.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/label_image.hpp"
#include "tests/cli/command_test.hpp"

namespace roadstereo {
namespace {

namespace fs = std::filesystem;

using EvaluateDamage = CommandTest;
using EvaluateDamageRealData = CommandTest;

using SlowEvaluateDamage = EvaluateDamage;

TEST_F(SlowEvaluateDamage, ScoresSyntheticRoads) {
  const Outcome outcome = run("evaluate damage --scenes 3 --json score.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Damage found"), std::string::npos);
  EXPECT_NE(outcome.out.find("Measured against the truth"), std::string::npos);
  const auto score = nlohmann::json::parse(read_text(folder_ / "score.json"));
  EXPECT_EQ(score["experiment"], "damage");
  EXPECT_EQ(score["scenes"], 3);
  EXPECT_EQ(score["false_positives"], 0);
  const auto& detection = score["detection"];
  ASSERT_FALSE(detection.empty());
  EXPECT_GE(detection.back()["recall"], 0.7);  // five of seven; over 20 roads it is 0.83
  EXPECT_EQ(score["measurement"].size(), 4U);
  double regions = 0;
  for (const auto& bin : score["confidence"]) regions += bin["regions"].get<double>();
  EXPECT_EQ(regions, score["found_regions"].size());
  EXPECT_GE(score["confidence"].back()["regions"], 3);
  EXPECT_EQ(score["confidence"].back()["damage_share"], 1);
}

TEST_F(EvaluateDamage, WideScenesAreDegradedThemselves) {
  EXPECT_EQ(run("evaluate damage --wide --degraded").exit_code, 2);
  const Outcome outcome = run("evaluate damage --wide --scenes 2 --seed 204 --json score.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto score = nlohmann::json::parse(read_text(folder_ / "score.json"));
  EXPECT_EQ(score["scenes"], 2);
  EXPECT_EQ(score["false_positives"], 0);
  EXPECT_GE(score["detection"].back()["found_of_those"], 2);
}

TEST_F(EvaluateDamage, RutsRunThroughThePicture) {
  EXPECT_EQ(run("evaluate damage --ruts --wide").exit_code, 2);
  const Outcome outcome = run("evaluate damage --ruts --scenes 2 --json score.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto score = json_file("score.json");
  EXPECT_EQ(score["false_positives"], 0);
  const auto& ruts = score["detection"][0];
  EXPECT_EQ(ruts["kind"], "rut");
  EXPECT_GE(ruts["found_of_those"], 2);
  EXPECT_EQ(score["measurement"][0]["quantity"], "depth of ruts");
}

TEST_F(EvaluateDamage, RejectsOtherFolders) {
  const Outcome outcome = run("evaluate damage .");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

TEST_F(EvaluateDamage, LabelledPairsNeedNoScan) {
  ASSERT_EQ(run("synth --scene demo --size 640x360 --output scene --quiet").exit_code, 0);
  for (const auto& [from, to] :
       {std::pair{"left.png", "left"}, {"right.png", "right"}, {"truth_labels.png", "label"}}) {
    fs::create_directories(folder_ / "pairs" / to);
    fs::copy_file(folder_ / "scene" / from, folder_ / "pairs" / to / "p1_00.png");
  }
  const Outcome without = run("evaluate damage pairs");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("no calibration_p….yaml for p1, and no calibration.yaml"), std::string::npos)
      << without.err;
  fs::copy_file(folder_ / "scene/calibration.yaml", folder_ / "pairs/calibration.yaml");
  const Outcome outcome = run("evaluate damage pairs --json score.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto row = json_file("score.json")["rows"][0];
  EXPECT_EQ(row["frame"], "p1_00");
  EXPECT_GT(row["found"], 0) << row;
  // The same grey levels in 10 of 16 bits.
  for (const std::string view : {"left", "right"}) {
    const std::string file = "pairs/" + view + "/p1_00.png";
    GreyImage grey;
    to_grey(io::read_frame((folder_ / file).string()).view(), 0, grey);
    Image<std::uint16_t> deep(grey.width(), grey.height());
    std::transform(grey.row(0), grey.row(0) + grey.pixels(), deep.row(0),
                   [](std::int16_t level) { return static_cast<std::uint16_t>(level / (grey_scale / 4)); });
    write(file, io::encode_label_png(deep));
  }
  ASSERT_EQ(run("evaluate damage pairs --json deep.json").exit_code, 0);
  EXPECT_NEAR(json_file("deep.json")["rows"][0]["f"].get<double>(), row["f"].get<double>(), 0.02);
}

/// Scores of the frames of a folder, without the line of them all.
nlohmann::json frames_in(const fs::path& report) {
  auto rows = nlohmann::json::parse(read_text(report))["rows"];
  rows.erase(rows.size() - 1);
  return rows;
}

TEST_F(EvaluateDamageRealData, TransformedMapsMatchLabels) {
  const auto data = data_folder("transformed");
  if (!data) GTEST_SKIP() << "ROADSTEREO_DATA has no folder transformed";
  ASSERT_EQ(run("evaluate damage '" + data->string() + "' --json score.json").exit_code, 0);
  const auto rows = frames_in(folder_ / "score.json");
  EXPECT_GE(rows.size(), 6U);
  for (const auto& row : rows) {
    EXPECT_GE(row["f"], 0.86) << row;
    EXPECT_EQ(row["false_positives"], 0) << row;
  }
}

TEST_F(EvaluateDamageRealData, PotholePairsMatchLabels) {
  const auto data = data_folder("potholes");
  if (!data) GTEST_SKIP() << "ROADSTEREO_DATA has no folder potholes";
  ASSERT_EQ(run("evaluate damage '" + data->string() + "' --json score.json").exit_code, 0);
  const auto rows = frames_in(folder_ / "score.json");
  EXPECT_FALSE(rows.empty());
  for (const auto& row : rows) {
    EXPECT_GE(row["f"], 0.80) << row;
    EXPECT_EQ(row["false_positives"], 0) << row;
  }
}

TEST_F(EvaluateDamageRealData, RoadsOfAnotherRendererMatchTruth) {
  const auto data = data_folder("wider");
  if (!data) GTEST_SKIP() << "ROADSTEREO_DATA has no folder wider";
  ASSERT_EQ(run("evaluate damage '" + (*data / "synthetic").string() + "' --json score.json").exit_code, 0);
  const auto score = nlohmann::json::parse(read_text(folder_ / "score.json"));
  EXPECT_GE(score["detection"].back()["recall"], 0.7);
  EXPECT_LE(score["false_positives"], 1);
}

TEST_F(EvaluateDamageRealData, IntactStreetsHaveLittle) {
  const auto data = data_folder("kitti2015");
  if (!data) GTEST_SKIP() << "ROADSTEREO_DATA has no folder kitti2015";
  ASSERT_EQ(run("evaluate damage '" + data->string() + "' --json score.json").exit_code, 0);
  const auto rows = frames_in(folder_ / "score.json");
  EXPECT_FALSE(rows.empty());
  double found = 0;
  for (const auto& row : rows) {
    found += row["false_depressions"].get<double>() + row["false_protrusions"].get<double>();
  }
  EXPECT_LE(found / static_cast<double>(rows.size()), 0.25);
}

}  // namespace
}  // namespace roadstereo

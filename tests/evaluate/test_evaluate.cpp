// `roadstereo evaluate` from outside: what it prints and writes, against maps whose scores are known by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cli/command_test.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr int width = 40, height = 32;

class Evaluate : public CommandTest {
 protected:
  Outcome run(const std::string& arguments) const { return CommandTest::run("evaluate " + arguments); }
};
using EvaluateScore = Evaluate;
using EvaluateRealData = Evaluate;
using SlowEvaluate = Evaluate;

/// The truth is 20 px everywhere but in the first row, which is unlabelled. The map is right in the left half but for
/// its first column, which is missing, and 2.5 px too high in the right half.
Image<float> example_truth() {
  Image<float> truth(width, height, 20.0F);
  for (int u = 0; u < width; ++u) truth(u, 0) = none;
  return truth;
}
Image<float> example_map() {
  Image<float> map(width, height, 20.0F);
  for (int v = 0; v < height; ++v) {
    map(0, v) = none;
    for (int u = width / 2; u < width; ++u) map(u, v) = 22.5F;
  }
  return map;
}

TEST_F(EvaluateScore, MatchesExampleByHand) {
  write("map.tiff", io::encode_float_tiff(example_map()));
  write("truth.png", io::encode_kitti_png(example_truth()));
  const Outcome outcome = run("score map.tiff truth.png --tolerances 1,3 --json score.json --figure score.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto score = json_file("score.json");
  // 31 labelled rows of 40 pixels; 39 of each have a disparity, 20 of them with an error of 2.5 px.
  EXPECT_NEAR(score["e_r_px"], 2.5 * std::sqrt(20.0 / 39), 1e-6);
  EXPECT_NEAR(score["mean_error_px"], 2.5 * 20 / 39, 1e-6);
  EXPECT_NEAR(score["median_error_px"], 2.5, 1e-6);
  EXPECT_NEAR(score["e_p_1px_percent"], 100.0 * 20 / 39, 1e-6);
  EXPECT_NEAR(score["e_p_3px_percent"], 0, 1e-6);
  EXPECT_NEAR(score["density_percent"], 97.5, 1e-6);
  EXPECT_NEAR(score["e_p_or_missing_1px_percent"], 52.5, 1e-6);
  EXPECT_NEAR(score["e_p_or_missing_3px_percent"], 2.5, 1e-6);
  EXPECT_NE(outcome.out.find("1209 of 1240"), std::string::npos) << outcome.out;
  EXPECT_GT(io::read_frame((folder_ / "score.png").string()).width, 2 * 40);  // maps of 40 columns side by side
}

TEST_F(EvaluateScore, CountsMaskOnly) {
  write("map.tiff", io::encode_float_tiff(example_map()));
  write("truth.tiff", io::encode_float_tiff(example_truth()));
  Frame mask{std::vector<std::uint8_t>(std::size_t{width} * height, 0), width, height};
  for (std::size_t i = 0; i < mask.bytes.size(); ++i) mask.bytes[i] = i % width < width / 2 ? 1 : 0;
  write("mask.png", io::encode_png(mask.view()));
  ASSERT_EQ(run("score map.tiff truth.tiff --mask mask.png --json score.json").exit_code, 0);
  EXPECT_EQ(json_file("score.json")["e_r_px"], 0);
  EXPECT_NEAR(json_file("score.json")["density_percent"], 95, 1e-6);
}

TEST_F(EvaluateScore, RejectsMapsThatDoNotCompare) {
  write("map.tiff", io::encode_float_tiff(example_map()));
  write("small.tiff", io::encode_float_tiff(Image<float>(width, height + 1, 1.0F)));
  write("empty.tiff", io::encode_float_tiff(Image<float>(width, height, none)));
  expect_complaint(run("score map.tiff absent.tiff"), "absent.tiff");
  expect_complaint(run("score map.tiff small.tiff"), "40×33");
  expect_complaint(run("score map.tiff empty.tiff"), "empty.tiff");
  expect_complaint(run("score map.tiff map.tiff --tolerances -1"), "-1 px");
  expect_complaint(run("score map.tiff map.tiff --json absent/score.json"), "absent/score.json");
}

TEST_F(Evaluate, RejectsFoldersOfOtherLayout) {
  expect_complaint(run(""), "");
  expect_complaint(run("kitti absent"), "absent");
  expect_complaint(run("middlebury absent"), "absent");
  fs::create_directories(folder_ / "kitti2015/disp_noc_0");
  expect_complaint(run("kitti kitti2015"), "PNG");
  write("kitti2015/disp_noc_0/000000_10.png", io::encode_kitti_png(example_truth()));
  expect_complaint(run("kitti kitti2015"), "image_2/000000_10.png");
  expect_complaint(run("middlebury kitti2015"), "im0.png");
}

TEST_F(Evaluate, HelpNamesEveryExperiment) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const std::string name : {"score", "kitti", "middlebury", "synth", "sigma", "subpixel", "ablation"}) {
    EXPECT_NE(help.out.find(name), std::string::npos) << name;
    EXPECT_NE(run(name + " --help").out.find("roadstereo evaluate " + name), std::string::npos) << name;
  }
}

TEST_F(Evaluate, OdometryLinksFirstFrameWithoutPrediction) {
  const Outcome outcome = run("odometry --flight loop=300 --frames 3 --json odometry.json --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("odometry.json")["rows"][0]["lost"], 0);
}

TEST_F(SlowEvaluate, SynthComparesEveryMethodInEveryGroup) {
  const Outcome outcome = run("synth --sizes small --json synth.json --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto document = json_file("synth.json");
  EXPECT_EQ(document["visible"].size(), 8U * 7U);
  EXPECT_EQ(document["damage"].size(), 8U * 7U);
  EXPECT_EQ(document["sub_pixel_bias"].size(), 7U);
  EXPECT_EQ(document["sub_pixel_phases"]["SGBM"]["mean_error_px"].size(), 20U);
  EXPECT_EQ(document["best_damage"].size(), 8U);
  EXPECT_NE(outcome.out.find("of 8 groups"), std::string::npos);
  EXPECT_EQ(document["common"].size(), 8U * 7U);
  for (const auto& row : document["common"]) {
    if (row["method"] != "BM") {
      EXPECT_EQ(row["density_percent"], 100) << row;
    }
  }
  int clean = 0;
  for (const auto& row : document["visible"]) {
    if (row["group"] != "clean" || row["method"] != "default") continue;
    ++clean;
    // 1.25 times what was measured.
    EXPECT_LE(row["e_p_or_missing_1px_percent"].get<double>(), 1.25 * 0.0297);
    EXPECT_LE(row["e_r_px"].get<double>(), 1.25 * 0.0251);
  }
  EXPECT_EQ(clean, 1);
  EXPECT_EQ(run("synth --sizes tiny").exit_code, 2);
}

TEST_F(SlowEvaluate, SigmaSplitsPixelsIntoTenths) {
  const Outcome outcome = run("sigma --sizes small --preset fast --json sigma.json --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("goal: 90–97 %"), std::string::npos) << outcome.out;
  const auto document = json_file("sigma.json");
  ASSERT_EQ(document["groups"].size(), 2U * 9U);
  double in_groups = 0, in_bins = 0;
  for (const auto& row : document["groups"]) {
    if (row["where"] == "visible" && row["group"] != "all") in_groups += row["pixels"].get<double>();
    EXPECT_LE(row["within_1_sigma_percent"], row["within_2_sigma_percent"]);
  }
  ASSERT_EQ(document["bins"].size(), 10U);
  for (const auto& bin : document["bins"]) in_bins += bin["pixels"].get<double>();
  EXPECT_EQ(in_groups, in_bins);
  EXPECT_LT(document["bins"][0]["sigma_px"], document["bins"][9]["sigma_px"]);
}

TEST_F(SlowEvaluate, AblationComparesEveryVariantWithPreset) {
  const Outcome outcome = run("ablation --sizes small --json ablation.json --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto variants = json_file("ablation.json")["variants"];
  const auto figure = [&](const std::string& variant, const char* key) {
    for (const auto& row : variants) {
      if (row["variant"] == variant) return row[key].get<double>();
    }
    ADD_FAILURE() << "no variant " << variant;
    return 0.0;
  };
  // Whole pixels for every disparity, as against a parabola: the error is uniform in ±0.5 px, its median 0.25 px.
  EXPECT_NEAR(figure("paper, no sub-pixel parabola", "clean_median_error_px"), 0.25, 0.05);
  EXPECT_LT(figure("paper", "clean_median_error_px"), 0.1);
  // A saw-tooth of half a pixel from row to row, which the refinement takes out of the road, but not out of damage.
  EXPECT_GT(figure("whole-pixel shift, no Lucas–Kanade step", "damage_e_r_px"), figure("default", "damage_e_r_px"));
  EXPECT_FALSE(variants[0].contains("kitti_e_r_px"));
  EXPECT_EQ(variants.back()["preset"], "paper");
  expect_complaint(run("ablation --kitti absent"), "absent");
}

TEST_F(EvaluateRealData, KittiShowsPublishedTable) {
  const auto data = data_folder("kitti2015");
  if (!data) GTEST_SKIP() << "SKIPPED: no real data; set ROADSTEREO_DATA to a folder that has kitti2015";
  for (const char* part : {"image_2", "image_3", "disp_noc_0", "road"}) {
    fs::create_directories(folder_ / "frames" / part);
    fs::copy_file(*data / part / "000007_10.png", folder_ / "frames" / part / "000007_10.png");
  }
  const Outcome outcome = run("kitti frames --json kitti.json --figure kitti.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part : {"PSMNet (published)", "1.345", "0.217", "SGBM", "000007_10"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  }
  const auto road = json_file("kitti.json")["road"];
  EXPECT_EQ(road["mean"], road["frames"]["000007_10"]);  // of one frame
  EXPECT_EQ(road["mean"].size(), 7U);
  const auto row_list = json_file("kitti.json")["road_common"]["mean"];
  EXPECT_EQ(row_list.size(), 7U);
  for (const auto& row : row_list) {
    if (row["method"] != "BM") {
      EXPECT_EQ(row["density_percent"], 100) << row;
    }
  }
  const auto published = json_file("kitti.json")["published"];
  EXPECT_NEAR(published[0]["e_r_px"], 1.039, 1e-9);
  EXPECT_NEAR(published[1]["e_p_2px_percent"], 0.217, 1e-9);
  EXPECT_TRUE(published[1]["density_percent"].is_null());
}

TEST_F(EvaluateRealData, MiddleburyTakesOneScene) {
  const auto data = data_folder("middlebury");
  if (!data) GTEST_SKIP() << "SKIPPED: no real data; set ROADSTEREO_DATA to a folder that has middlebury";
  const Outcome outcome = run("middlebury '" + (*data / "Motorcycle").string() + "' --json middlebury.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Motorcycle, 70 disparities"), std::string::npos) << outcome.out;
  EXPECT_EQ(json_file("middlebury.json")["Motorcycle"].size(), 7U);
}

TEST_F(SlowEvaluate, LambdaWritesRowPerRate) {
  const Outcome outcome = run("lambda --count 2 --json lambda.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lambda = json_file("lambda.json");
  ASSERT_EQ(lambda["rows"].size(), 2U);
  EXPECT_NEAR(lambda["rows"][0]["lambda"], 0.01, 1e-12);
  EXPECT_NEAR(lambda["rows"][1]["lambda"], 1e4, 1e-6);
  EXPECT_EQ(lambda["published_optimum"], 10);
}

/// Writes a rendered scene with everything that a source of single scenes has.
void write_scene(const fs::path& folder, const synth::Scene& scene) {
  const synth::SyntheticPair pair = synth::render(scene);
  fs::create_directories(folder);
  const auto write = [&folder](const char* name, const std::vector<std::uint8_t>& bytes) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  Image<float> truth(pair.disparity.width(), pair.disparity.height());
  Frame region{std::vector<std::uint8_t>(truth.pixels(), 0), truth.width(), truth.height()}, seen = region;
  for (std::size_t i = 0; i < truth.pixels(); ++i) {
    truth.row(0)[i] = static_cast<float>(pair.disparity.row(0)[i]);
    region.bytes[i] = std::isnan(truth.row(0)[i]) ? 0 : 1;
    seen.bytes[i] = pair.visible.row(0)[i];
  }
  write("left.png", io::encode_png(pair.left.view()));
  write("right.png", io::encode_png(pair.right.view()));
  write("disparity.tiff", io::encode_float_tiff(truth));
  write("region.png", io::encode_png(region.view()));
  write("occ.png", io::encode_png(seen.view()));
}

TEST_F(Evaluate, RobustnessFindsSourcesByContent) {
  synth::Scene scene = synth::named_scene("demo");
  scene.rig.focal_px /= 2;
  scene.rig.width = 320;
  scene.rig.height = 180;
  write_scene(folder_ / "data/scenes/intact", scene);
  scene.degradation.noise_grey = 100;
  scene.road.texture_contrast = 0;
  write_scene(folder_ / "data/scenes/noise", scene);
  ASSERT_EQ(CommandTest::run("synth --scene demo --size 320x180 --frames 3 --output data/drive --quiet").exit_code, 0);
  const Outcome outcome = run("robustness data --scenes 0 --json robustness.json --figure worst.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto document = json_file("robustness.json");
  ASSERT_EQ(document["roads"].size(), 1U);
  EXPECT_EQ(document["roads"][0]["source"], "data/scenes");
  EXPECT_EQ(document["roads"][0]["frame_count"], 2);
  EXPECT_EQ(document["roads"][0]["found_percent"], 50);
  EXPECT_EQ(document["roads"][0]["worst_frame"], "noise");
  ASSERT_EQ(document["disparities"].size(), 5U);  // methods
  const auto frames = document["frames"]["data/scenes"];
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]["status"], "found");
  EXPECT_LT(frames[0]["plane_px"], 0.5);
  EXPECT_EQ(frames[1]["status"], "none");
  EXPECT_TRUE(frames[1]["plane_px"].is_null());
  ASSERT_EQ(document["drives"].size(), 1U);
  EXPECT_EQ(document["drives"][0]["frame_count"], 3);
  EXPECT_NEAR(document["drives"][0]["tracked_percent"], 200.0 / 3, 1e-9);
  EXPECT_EQ(document["drives"][0]["none_percent"], 0);
  EXPECT_GE(io::read_frame((folder_ / "worst.png").string()).width, 640);
  fs::create_directories(folder_ / "empty");
  expect_complaint(run("robustness empty"), "empty: there are no labelled pairs");
  expect_complaint(run("robustness absent"), "absent is not a folder");
}

// Without damage every solver finds the roll of a plane; the paper's mean error stands beside them.
TEST_F(SlowEvaluate, RollOfCleanMapsIsExact) {
  const Outcome outcome = run("roll --angles 1 --max-roll 7 --no-pairs --json roll.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto roll = json_file("roll.json");
  EXPECT_EQ(roll["rows"][0]["mean_rad"], 0.012);
  int clean = 0;
  for (const auto& row : roll["rows"]) {
    if (row["maps"] != "rolled rig, clean") continue;
    EXPECT_LT(row["max_rad"], 1e-6) << row["solver"];
    ++clean;
  }
  EXPECT_EQ(clean, 3);
}

TEST_F(Evaluate, BlurComparesThreeMethods) {
  const Outcome outcome = run("blur --steps 2 --max-length 4 --directions 0 --json blur.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file("blur.json")["trials"].size(), 6U);
}

TEST_F(Evaluate, RuntimeCountsDisparitiesPerSecond) {
  const Outcome outcome = run("runtime --size 160x96 --disparities 16 --runs 1 --json runtime.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto row_list = json_file("runtime.json")["rows"];
  int published_rows = 0;
  for (const auto& row : row_list) {
    const bool published = row["method"].get<std::string>().starts_with("published");
    published_rows += published ? 1 : 0;
    const double evaluations = published ? 695.0 * 361 * 30 : 160.0 * 96 * 16;
    const double per_second = evaluations / row["total_ms"].get<double>() / 1e3;
    EXPECT_NEAR(row["mde_per_s"].get<double>() / per_second, 1, 1e-4) << row["method"];
  }
  EXPECT_GE(published_rows, 1);
  EXPECT_GT(static_cast<int>(row_list.size()), published_rows);
}

TEST_F(EvaluateRealData, RollCorrectionFlattensKittiRoads) {
  const auto data = data_folder("kitti2015");
  if (!data) GTEST_SKIP() << "SKIPPED: no real data; set ROADSTEREO_DATA to a folder that has kitti2015";
  const Outcome outcome = run("flatness '" + data->string() + "' --preset fast --json flatness.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto row_list = json_file("flatness.json")["rows"];
  EXPECT_GE(row_list.size(), 10U) << "frames";
  for (const auto& row : row_list) {
    // One unknown more fits no worse.
    EXPECT_LE(row["gradient_descent_px"], row["without_roll_px"]) << row;
  }
}

TEST_F(Evaluate, RejectsBadOptions) {
  expect_complaint(run("lambda --min-lambda 5 --max-lambda 1"), "--min-lambda 5");
  expect_complaint(run("roll --angles 0"), "--angles is 0");
  expect_complaint(run("blur --scene bluur"), "did you mean");
  expect_complaint(run("runtime --size 10"), "--size must be WIDTHxHEIGHT");
  expect_complaint(run("flatness nowhere"), "nowhere");
}

}  // namespace

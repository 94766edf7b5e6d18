// Maps of other matchers, regions drawn by hand, the lane, and the page of the paper.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "evaluate/lane.hpp"
#include "evaluate/paper_page.hpp"
#include "evaluation/polygon_mask.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/synth.hpp"
#include "tests/cli/command_test.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadstereo;
using namespace roadstereo::cli;

/// Waves whose gradient points `angle_deg` away from straight down.
GreyImage waves(double angle_deg) {
  GreyImage grey(64, 48);
  const double angle = angle_deg * std::numbers::pi / 180;
  for (int v = 0; v < grey.height(); ++v) {
    for (int u = 0; u < grey.width(); ++u) {
      const double phase = 0.3 * (v * std::cos(angle) + u * std::sin(angle));
      grey(u, v) = static_cast<std::int16_t>(std::lround(2000 + 1500 * std::sin(phase)));
    }
  }
  return grey;
}

TEST(Lane, EdgeIsFourTimesAsSteepDown) {
  // The ratio of the gradients is the cotangent of the angle: 4 at 14.04°.
  const auto share = [](double angle_deg) {
    const Image<std::uint8_t> edges = edges_along_rows(waves(angle_deg));
    std::size_t count = 0;
    for (int v = 8; v < 40; ++v) {
      for (int u = 8; u < 56; ++u) count += edges(u, v) != 0 ? 1U : 0U;
    }
    return static_cast<double>(count) / (32 * 48);
  };
  EXPECT_EQ(share(0), 1);
  EXPECT_GT(share(12), 0.95);
  EXPECT_LT(share(16), 0.05);
  EXPECT_EQ(share(90), 0);
  EXPECT_EQ(edges_along_rows(GreyImage(32, 32, 100))(16, 16), 0);  // no gradient at all
}

TEST(Lane, IsInMetres) {
  const StereoCalibration calibration{700, 50, 40, 0.5, 0, 100, 80};  // Z = 350 / d
  Image<float> truth(100, 80, 35.0F);                                 // 10 m away: 1.75 m are 122.5 px
  const Image<std::uint8_t> road(100, 80, 1);
  EXPECT_EQ(lane_mask(truth, road, calibration)(0, 0), 255);
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) truth(u, v) = 350.0F / 2;  // 2 m away: 612.5 px
  }
  EXPECT_EQ(lane_mask(truth, road, calibration)(99, 79), 255);
  truth(10, 10) = 350.0F / 15.1F;
  truth(11, 10) = 350.0F / 14.9F;
  truth(12, 10) = std::nanf("");
  const StereoCalibration aside{700, 50 - 0.176 * 700, 40, 0.5, 0, 100, 80};  // X = 0.176 Z + …
  EXPECT_EQ(lane_mask(truth, road, calibration)(10, 10), 0);
  EXPECT_EQ(lane_mask(truth, road, calibration)(11, 10), 255);
  EXPECT_EQ(lane_mask(truth, road, calibration)(12, 10), 0);
  Image<float> far(100, 80, 35.0F);
  EXPECT_EQ(lane_mask(far, road, aside)(50, 40), 0);  // 1.76 m
  EXPECT_EQ(lane_mask(far, Image<std::uint8_t>(100, 80, 0), calibration)(50, 40), 0);
}

TEST(PolygonMask, FillsByEvenOddRule) {
  const Polygon outer{{2, 3}, {20, 3}, {20, 15}, {2, 15}};
  const Polygon inner{{6, 6}, {12, 6}, {12, 10}, {6, 10}};
  const Image<std::uint8_t> mask = polygon_mask({outer, inner}, 32, 24);
  std::size_t inside = 0;
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 32; ++u) inside += mask(u, v) != 0 ? 1U : 0U;
  }
  // 19 × 13 pixels with the border, without the 5 × 3 strictly inside the inner one.
  EXPECT_EQ(inside, 19U * 13 - 5U * 3);
  EXPECT_EQ(mask(9, 8), 0);
  EXPECT_EQ(mask(4, 4), 255);
  EXPECT_EQ(mask(21, 8), 0);
}

class GivenMaps : public CommandTest {
 protected:
  /// A frame of KITTI 2012 in grey, rendered.
  void write_frame() {
    synth::Scene scene = synth::named_scene("street");
    scene.rig.focal_px *= 320.0 / scene.rig.width;
    scene.rig.width = 320;
    scene.rig.height = 180;
    const synth::SyntheticPair pair = synth::render(scene);
    for (const char* part : {"k/image_0", "k/image_1", "k/disp_noc", "k/calib", "mine", "shifted"}) {
      fs::create_directories(folder_ / part);
    }
    write("k/image_0/000000_10.png", io::encode_png(pair.left.view()));
    write("k/image_1/000000_10.png", io::encode_png(pair.right.view()));
    Image<float> truth(320, 180);
    for (int v = 0; v < 180; ++v) {
      for (int u = 0; u < 320; ++u) {
        truth(u, v) = pair.visible(u, v) != 0 ? static_cast<float>(pair.disparity(u, v)) : std::nanf("");
      }
    }
    write("k/disp_noc/000000_10.png", io::encode_kitti_png(truth));
    write("mine/000000_10.png", io::encode_kitti_png(truth));
    for (int v = 0; v < 180; ++v) {
      for (int u = 0; u < 320; ++u) truth(u, v) += 2.5F;
    }
    write("shifted/000000_10.tiff", io::encode_float_tiff(truth));
    const StereoCalibration& c = pair.calibration;
    const auto row = [&](double shift) {
      std::ostringstream text;
      text << c.focal_px << " 0 " << c.cx_px << " " << shift << " 0 " << c.focal_px << " " << c.cy_px << " 0 0 0 1 0";
      return text.str();
    };
    write("k/calib/000000.txt", "P0: " + row(0) + "\nP1: " + row(-c.focal_px * c.baseline_m) + "\n");
    write("regions.json", std::string(R"({"000000_10": [[[40, 120], [280, 120], [300, 175], [20, 175]]]})"));
  }
};

using SlowGivenMaps = GivenMaps;

TEST_F(GivenMaps, StandInTheTableOfKitti) {
  write_frame();
  const Outcome outcome =
      run("evaluate kitti k --maps mine=mine --maps shifted=shifted --road-masks regions.json --json kitti.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto document = json_file("kitti.json");
  for (const char* region : {"road", "road_common", "lane", "lane_without_edges", "all"}) {
    ASSERT_EQ(document[region]["mean"].size(), 9U) << region;
    const auto& mine = document[region]["mean"][7];
    EXPECT_EQ(mine["method"], "mine");
    EXPECT_EQ(mine["e_r_px"], 0) << region;
    EXPECT_EQ(mine["density_percent"], 100) << region;
    const auto& shifted = document[region]["mean"][8];
    EXPECT_NEAR(shifted["e_r_px"], 2.5, 1e-4) << region;  // single precision
    EXPECT_EQ(shifted["e_p_2px_percent"], 100) << region;
    EXPECT_EQ(shifted["e_p_3px_percent"], 0) << region;
  }
  EXPECT_NE(outcome.out.find("Lane without edges"), std::string::npos);
}

TEST_F(GivenMaps, AreRejectedInOneSentence) {
  write_frame();
  const auto expect = [&](const std::string& arguments, const std::string& part) {
    const Outcome outcome = run("evaluate kitti k " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  expect("--maps mine", "NAME=DIR");
  expect("--maps SGBM=mine", "name of another method");
  expect("--maps mine=absent", "absent is not a folder");
  expect("--maps mine=k/calib", "contains no 000000_10.png");
  expect("--maps mine=k/image_0", "8 bit");
  write("bad.json", std::string(R"({"000000_10": [[[1, 2], [3]]]})"));
  expect("--road-masks bad.json", "at least three corners");
  write("bad.json", std::string(R"({"000000_10": [[[1, 2], [3], [4, 5]]]})"));
  expect("--road-masks bad.json", "must be two numbers");
  write("bad.json", std::string("[]"));
  expect("--road-masks bad.json", "not a JSON object");
}

TEST_F(SlowGivenMaps, OfRenderedRoadsAreComparedOnDamage) {
  ASSERT_EQ(run("evaluate damage --scenes 1 --seed 1003 --write-pairs pairs").exit_code, 0);
  const Frame left = io::read_frame((folder_ / "pairs/left/001003.png").string());
  const synth::SyntheticPair pair = synth::render(synth::random_scene(1003, false));
  EXPECT_EQ(left.bytes, pair.left.bytes);
  EXPECT_TRUE(fs::is_regular_file(folder_ / "pairs/calibration/001003.yaml"));
  Image<float> truth(left.width, left.height);
  for (int v = 0; v < left.height; ++v) {
    for (int u = 0; u < left.width; ++u) truth(u, v) = static_cast<float>(pair.disparity(u, v));
  }
  fs::create_directories(folder_ / "maps");
  write("maps/001003.tiff", io::encode_float_tiff(truth));
  const Outcome outcome = run("evaluate damage --scenes 1 --seed 1003 --maps exact=maps --json score.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto score = json_file("score.json");
  ASSERT_EQ(score["detection"].size(), 6U);  // two kinds and their sum, of two methods
  EXPECT_EQ(score["detection"][5]["method"], "exact");
  EXPECT_EQ(score["detection"][5]["recall"], 1) << outcome.out;  // of exact disparities
  EXPECT_EQ(score["maps"]["exact"]["false_positives"], 0);
  EXPECT_EQ(score["measurement"].size(), 8U);
}

TEST(PaperPage, EscapesMarkup) {
  PaperPage page{"A & B", "introduction", {}};
  PaperPart part{"Table <1>", "roadstereo evaluate kitti", {}, "kitti.png", "because"};
  part.table = {"", {{"x", "x"}, {"value", "value"}}, {{Cell("a<b"), Cell(1.25, 2)}}};
  page.parts.push_back(part);
  EXPECT_NE(html(page).find("<td>a&lt;b</td><td>1.25</td>"), std::string::npos) << html(page);
  EXPECT_NE(html(page).find("<h2>Table &lt;1&gt;</h2>"), std::string::npos);
  EXPECT_NE(markdown(page).find("| x | value |\n| --- | --- |\n| a<b | 1.25 |\n"), std::string::npos) << markdown(page);
  EXPECT_EQ(json(page)["parts"][0]["rows"][0]["value"], 1.25);
  EXPECT_EQ(json(page)["parts"][0]["figure"], "kitti.png");
}

using SlowPaper = CommandTest;

TEST_F(SlowPaper, PageHasEveryExperimentWithoutKitti) {
  const Outcome outcome = run("evaluate paper --quick --output page");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto page = json_file("page/paper.json");
  std::string titles;
  for (const auto& part : page["parts"]) {
    titles += part["title"].get<std::string>() + "\n";
    if (part.contains("figure")) {
      EXPECT_GT(io::read_frame((folder_ / "page" / part["figure"].get<std::string>()).string()).width, 900);
    }
  }
  for (const char* word : {"Runtime", "λ(0)", "Roll angle", "motion blurred", "results", "KITTI"}) {
    EXPECT_NE(titles.find(word), std::string::npos) << word;
  }
  EXPECT_TRUE(fs::is_regular_file(folder_ / "page/paper.html"));
  EXPECT_TRUE(fs::is_regular_file(folder_ / "page/roll.json"));
}

}  // namespace

// Real pairs with ground truth. The folder is named by ROADSTEREO_DATA; without it every test here is skipped.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "road/plane_fit.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

std::optional<std::filesystem::path> data_folder(const std::string& part) {
  const char* folder = std::getenv("ROADSTEREO_DATA");
  if (folder == nullptr) return std::nullopt;
  const std::filesystem::path path = std::filesystem::path(folder) / part;
  if (!std::filesystem::is_directory(path)) return std::nullopt;
  return path;
}

#define REQUIRE_DATA(folder, part)       \
  const auto folder = data_folder(part); \
  if (!folder) GTEST_SKIP() << "SKIPPED: no real data; set ROADSTEREO_DATA to a folder that has " << (part)

/// Errors of a road model over the road area.
struct ModelError {
  double mean = 0;
  double worst_of_95_percent = 0;
  double largest = 0;
};

ModelError model_error(const RoadModel& model, const RoadModel& truth, const std::vector<DisparityPoint>& area) {
  std::vector<double> errors;
  double sum = 0;
  for (const DisparityPoint& p : area) {
    errors.push_back(std::abs(model.disparity(p.u, p.v) - truth.disparity(p.u, p.v)));
    sum += errors.back();
  }
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(errors.size()));
  std::nth_element(errors.begin(), at, errors.end());
  const double largest = *std::max_element(errors.begin(), errors.end());
  return {sum / static_cast<double>(errors.size()), *at, largest};
}

/// Intrinsics of the KITTI 2015 training frames, which depend on the recording day and so on the width.
StereoCalibration kitti_calibration(int width) {
  const double focal = width == 1242 ? 721.54 : (width == 1238 ? 718.34 : 707.05);
  return {focal, 609.56, 172.85, 0.5327, 0, 0, 0};
}

class Kitti : public testing::TestWithParam<const char*> {};

TEST_P(Kitti, RoadModelIsTheRoadOfTheGroundTruth) {
  REQUIRE_DATA(folder, "kitti2015");
  const std::string file = std::string(GetParam()) + "_10.png";
  const Frame left = io::read_frame((*folder / "image_2" / file).string());
  const Frame right = io::read_frame((*folder / "image_3" / file).string());
  const Image<float> truth = io::read_disparity((*folder / "disp_noc_0" / file).string());
  const Frame mask = io::read_frame((*folder / "road" / file).string());
  std::vector<DisparityPoint> road;
  PlaneSums sums;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const auto pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(truth.width()) + static_cast<std::size_t>(u);
      if (mask.bytes[pixel] == 0 || std::isnan(truth(u, v))) continue;
      road.push_back({static_cast<double>(u), static_cast<double>(v), truth(u, v)});
      sums.add(road.back());
    }
  }
  const RoadModel plane = *sums.plane();

  Pipeline pipeline(preset("default"), kitti_calibration(left.width));
  const FrameResult& result = pipeline.process(left.view(), right.view());
  ASSERT_TRUE(result.road.reliable) << result.road.reason;
  const ModelError before = model_error(result.road.model, plane, road);
  EXPECT_LT(before.mean, 1.0);
  EXPECT_LT(before.worst_of_95_percent, 2.0);
  const ModelError after = model_error(result.geometry.plane, plane, road);
  EXPECT_LT(after.mean, 1.0);
  EXPECT_LT(after.worst_of_95_percent, 1.5);

  double missing = 0, squares = 0;
  std::array<double, 3> wrong{};  // by more than 1, 2, 3 px (eq. e_pep)
  for (const DisparityPoint& p : road) {
    const double error = std::abs(result.disparity(static_cast<int>(p.u), static_cast<int>(p.v)) - p.d);
    if (std::isnan(error)) {
      missing += 1;
      continue;
    }
    squares += error * error;
    for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i] += error > static_cast<double>(i + 1);
  }
  const auto pixels = static_cast<double>(road.size());
  const double found = pixels - missing;
  std::printf(
      "%s: road model mean %.2f largest %.2f px, after matching largest %.2f px, roll %.3f ± %.3f°, sigma_d %.2f px, "
      "density %.1f %%, e_r %.2f px, e_p %.1f %.1f %.1f %%\n",
      GetParam(), before.mean, before.largest, after.largest, result.geometry.roll_rad * 180 / M_PI,
      result.geometry.roll_stderr_rad * 180 / M_PI, result.spread.road_px, 100 * found / pixels,
      std::sqrt(squares / found), 100 * wrong[0] / found, 100 * wrong[1] / found, 100 * wrong[2] / found);
  EXPECT_LT(missing / pixels, 0.10);
  EXPECT_LT(wrong[2] / pixels, 0.06);
}

INSTANTIATE_TEST_SUITE_P(Frames, Kitti,
                         testing::Values("000003", "000007", "000013", "000016", "000020", "000025", "000030", "000036",
                                         "000152", "000158"),
                         [](const auto& test) { return std::string(test.param); });

struct Pothole {
  const char* name;
  const char* calibration;
  double least_depth_px;  ///< by which the labelled pothole must lie below the road somewhere
};

class Potholes : public testing::TestWithParam<Pothole> {};

TEST_P(Potholes, RoadIsFlatAndThePotholeLiesBelowIt) {
  REQUIRE_DATA(folder, "potholes");
  const std::string file = std::string(GetParam().name) + ".png";
  const Frame left = io::read_frame((*folder / "left" / file).string());
  const Frame right = io::read_frame((*folder / "right" / file).string());
  const Frame label = io::read_frame((*folder / "label" / file).string());
  const auto calibration = io::read_calibration((*folder / GetParam().calibration).string());
  Pipeline pipeline(preset("default"), calibration.rectified);
  const FrameResult& result = pipeline.process(left.view(), right.view());
  ASSERT_TRUE(result.road.reliable) << result.road.reason;
  EXPECT_TRUE(result.geometry.roll_observable);
  EXPECT_GT(result.valid_share, 0.85);

  // The robust plane of the dense map outside the label is the truth of the model found before matching.
  std::vector<DisparityPoint> road;
  std::vector<double> depths;
  double labelled = 0;
  const int channels = channel_count(label.order);
  for (int v = 0; v < label.height; v += 3) {
    for (int u = 0; u < label.width; u += 3) {
      const float d = result.disparity(u, v);
      const auto pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(label.width) + static_cast<std::size_t>(u);
      const bool on_pothole = label.bytes[pixel * static_cast<std::size_t>(channels)] != 0;
      labelled += on_pothole;
      if (std::isnan(d)) continue;
      if (!on_pothole) {
        road.push_back({static_cast<double>(u), static_cast<double>(v), d});
      } else {
        depths.push_back(result.delta_t - result.transformed(u, v));
      }
    }
  }
  const auto start = search_plane(road, 1.0);
  ASSERT_TRUE(start);
  const auto plane = fit_robust_plane(road, *start, 1.0, true, 100);
  ASSERT_TRUE(plane);
  EXPECT_LT(model_error(result.road.model, plane->plane, road).worst_of_95_percent, 1.5);
  EXPECT_LT(model_error(result.geometry.plane, plane->plane, road).worst_of_95_percent, 0.75);
  std::printf("%s: roll %.3f ± %.3f°, sigma_d %.2f px, valid %.1f %%, labelled pixels with a disparity %.1f %%\n",
              GetParam().name, result.geometry.roll_rad * 180 / M_PI, result.geometry.roll_stderr_rad * 180 / M_PI,
              result.spread.road_px, 100 * result.valid_share, 100 * static_cast<double>(depths.size()) / labelled);
  std::sort(depths.begin(), depths.end());
  EXPECT_GT(depths[depths.size() * 8 / 10], GetParam().least_depth_px);
}

INSTANTIATE_TEST_SUITE_P(Pairs, Potholes,
                         testing::Values(Pothole{"p1_01", "calibration_p12.yaml", 8},
                                         Pothole{"p1_05", "calibration_p12.yaml", 8},
                                         Pothole{"p1_12", "calibration_p12.yaml", 8},
                                         Pothole{"p2_17", "calibration_p12.yaml", 8},
                                         Pothole{"p3_03", "calibration_p3.yaml", 5}),
                         [](const auto& test) { return std::string(test.param.name); });

/// A part of a grey image.
ImageView<const std::int16_t> crop(const GreyImage& image, int u, int v, int width, int height) {
  return {image.row(v) + u, width, height, image.width()};
}

TEST(EngineAgreement, OnRealPairs) {
  REQUIRE_DATA(folder, "potholes");
  const Frame left = io::read_frame((*folder / "left" / "p1_01.png").string());
  const Frame right = io::read_frame((*folder / "right" / "p1_01.png").string());
  GreyImage reference, target, transformed;
  to_grey(left.view(), 0, reference);
  to_grey(right.view(), 0, target);
  PerspectiveShift shift;
  shift.road = {137.6, 0.1706, 0.0104};
  shift.delta_p = 24;
  shift.disparities = 33;
  std::vector<int> first;
  transform_target(target, shift, 0, transformed, first);
  // Part of the pothole, and the border of the common view.
  for (const auto& [u, v] : {std::pair{1080, 820}, std::pair{110, 300}}) {
    constexpr int width = 203, height = 101;
    std::vector<int> first_column;
    for (int y = 0; y < height; ++y) {
      first_column.push_back(std::clamp(first[static_cast<std::size_t>(v + y)] - u, 0, width));
    }
    const MatchInput input{crop(reference, u, v, width, height), crop(transformed, u, v, width, height),
                           first_column.data(), shift.disparities};
    for (const std::string& name : preset_names()) {
      const MatcherOptions options = preset(name).matcher;
      MatchMaps expected;
      make_engine("reference", 0)->match(input, options, expected);
      for (const EngineInfo& info : engines()) {
        if (info.exact) continue;
        MatchMaps actual;
        info.make(2)->match(input, options, actual);
        double same = 0, worst = 0;
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            if (expected.winner(x, y) != actual.winner(x, y)) continue;
            same += 1;
            const double difference = std::abs(expected.disparity(x, y) - actual.disparity(x, y));
            if (!std::isnan(difference)) worst = std::max(worst, difference);
          }
        }
        std::printf("%s against reference, preset %s: same winner %.3f %%, largest difference %.1e px\n",
                    info.name.c_str(), name.c_str(), 100 * same / (width * height), worst);
        EXPECT_GE(same / (width * height), 0.999) << info.name << " " << name;
        EXPECT_LE(worst, 0.01) << info.name << " " << name;
      }
    }
  }
}

TEST(Middlebury, AGeneralSceneStillGivesADisparityMap) {
  REQUIRE_DATA(folder, "middlebury");
  for (const char* scene : {"Motorcycle", "PlaytableP"}) {
    const Frame left = io::read_frame((*folder / scene / "im0.png").string());
    const Frame right = io::read_frame((*folder / scene / "im1.png").string());
    const Image<float> truth = io::read_disparity((*folder / scene / "disp0GT.pfm").string());
    PipelineOptions options = preset("default");
    options.perspective.enabled = false;  // no road here
    options.perspective.disparities = 70;
    Pipeline pipeline(options);
    const FrameResult& result = pipeline.process(left.view(), right.view());
    double valid = 0, good = 0;
    for (int v = 0; v < truth.height(); ++v) {
      for (int u = 0; u < truth.width(); ++u) {
        const double error = std::abs(result.disparity(u, v) - truth(u, v));
        if (std::isnan(error)) continue;
        valid += 1;
        good += error <= 2;
      }
    }
    EXPECT_GT(valid / static_cast<double>(truth.pixels()), 0.5) << scene;
    EXPECT_GT(good / valid, 0.75) << scene;
  }
}

}  // namespace
}  // namespace roadstereo

// Real pairs with ground truth. The folder is named by ROADSTEREO_DATA; without it every test here is skipped.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
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
};

ModelError model_error(const DisparityPlane& model, const DisparityPlane& truth,
                       const std::vector<DisparityPoint>& area) {
  std::vector<double> errors;
  double sum = 0;
  for (const DisparityPoint& p : area) {
    errors.push_back(std::abs(model.disparity(p.u, p.v) - truth.disparity(p.u, p.v)));
    sum += errors.back();
  }
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(errors.size()));
  std::nth_element(errors.begin(), at, errors.end());
  return {sum / static_cast<double>(errors.size()), *at};
}

/// Intrinsics of the KITTI 2015 training frames, which depend on the recording day and so on the width.
StereoCalibration kitti_calibration(int width) {
  const double focal = width == 1242 ? 721.54 : (width == 1238 ? 718.34 : 707.05);
  return {focal, 609.56, 172.85, 0.5327, 0, 0, 0};
}

/// How much worse than measured a figure may become.
constexpr double slack = 1.25;

void expect_at_most(const std::string& name, double value, double measured) {
  testing::Test::RecordProperty(name, std::to_string(value));
  EXPECT_LE(value, slack * measured) << name;
}

struct KittiFrame {
  Frame left, right;
  std::vector<DisparityPoint> road;  ///< the ground truth within the mask of the road
  DisparityPlane plane;              ///< its least-squares plane
};

KittiFrame read_kitti(const std::filesystem::path& folder, const std::string& name) {
  const std::string file = name + "_10.png";
  KittiFrame frame;
  frame.left = io::read_frame((folder / "image_2" / file).string());
  frame.right = io::read_frame((folder / "image_3" / file).string());
  const Image<float> truth = io::read_disparity((folder / "disp_noc_0" / file).string());
  const Frame mask = io::read_frame((folder / "road" / file).string());
  PlaneSums sums;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const auto pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(truth.width()) + static_cast<std::size_t>(u);
      if (mask.bytes[pixel] == 0 || std::isnan(truth(u, v))) continue;
      frame.road.push_back({static_cast<double>(u), static_cast<double>(v), truth(u, v)});
      sums.add(frame.road.back());
    }
  }
  frame.plane = sums.plane().value();
  return frame;
}

/// Figures of the disparities on one road.
struct RoadScore {
  double missing = 0;
  double rms_px = 0;                      ///< e_r
  double wrong_by_2 = 0, wrong_by_3 = 0;  ///< e_p, shares of the disparities that there are (eq. (33))
};

RoadScore score(const Image<float>& disparity, const std::vector<DisparityPoint>& road) {
  RoadScore sums;
  double found = 0;
  for (const DisparityPoint& p : road) {
    const double error = std::abs(disparity(static_cast<int>(p.u), static_cast<int>(p.v)) - p.d);
    if (std::isnan(error)) continue;
    found += 1;
    sums.rms_px += error * error;
    sums.wrong_by_2 += error > 2;
    sums.wrong_by_3 += error > 3;
  }
  const auto pixels = static_cast<double>(road.size());
  return {1 - found / pixels, std::sqrt(sums.rms_px / found), sums.wrong_by_2 / found, sums.wrong_by_3 / found};
}

struct KittiFigures {
  const char* frame;
  ModelError before, after;  ///< of the road model found before matching, and of the plane after it
};

class KittiRealData : public testing::TestWithParam<KittiFigures> {};

TEST_P(KittiRealData, RoadModelMatchesGroundTruth) {
  REQUIRE_DATA(folder, "kitti2015");
  const KittiFrame frame = read_kitti(*folder, GetParam().frame);
  Pipeline pipeline(preset("default"), kitti_calibration(frame.left.width));
  const FrameResult& result = pipeline.process(frame.left.view(), frame.right.view());
  ASSERT_TRUE(result.road.has_road()) << result.road.reason;
  const ModelError before = model_error(result.road.model, frame.plane, frame.road);
  expect_at_most("before_mean_px", before.mean, GetParam().before.mean);
  expect_at_most("before_95_percent_px", before.worst_of_95_percent, GetParam().before.worst_of_95_percent);
  const ModelError after = model_error(result.geometry.plane, frame.plane, frame.road);
  expect_at_most("after_mean_px", after.mean, GetParam().after.mean);
  expect_at_most("after_95_percent_px", after.worst_of_95_percent, GetParam().after.worst_of_95_percent);
}

constexpr KittiFigures kitti_frames[] = {
    {"000003", {0.337, 0.803}, {0.327, 0.815}}, {"000007", {0.577, 1.415}, {0.535, 1.137}},
    {"000013", {0.380, 0.861}, {0.276, 0.631}}, {"000016", {0.466, 1.014}, {0.337, 0.701}},
    {"000020", {0.230, 0.538}, {0.363, 0.673}}, {"000025", {0.214, 0.430}, {0.228, 0.453}},
    {"000030", {0.308, 0.865}, {0.328, 0.887}}, {"000036", {0.219, 0.599}, {0.210, 0.545}},
    {"000152", {0.738, 1.603}, {0.507, 1.054}}, {"000158", {0.454, 1.264}, {0.559, 1.072}}};

INSTANTIATE_TEST_SUITE_P(Frames, KittiRealData, testing::ValuesIn(kitti_frames),
                         [](const auto& test) { return std::string(test.param.frame); });

/// The means over the ten frames that README claims.
TEST(KittiMeanRealData, DisparitiesAreAsGoodAsDocumented) {
  REQUIRE_DATA(folder, "kitti2015");
  RoadScore mean;
  constexpr double share = 1.0 / std::size(kitti_frames);
  for (const KittiFigures& figures : kitti_frames) {
    const KittiFrame frame = read_kitti(*folder, figures.frame);
    Pipeline pipeline(preset("default"), kitti_calibration(frame.left.width));
    const RoadScore one = score(pipeline.process(frame.left.view(), frame.right.view()).disparity, frame.road);
    mean.missing += share * one.missing;
    mean.rms_px += share * one.rms_px;
    mean.wrong_by_2 += share * one.wrong_by_2;
    mean.wrong_by_3 += share * one.wrong_by_3;
  }
  // docs/accuracy.json has them in percent.
  expect_at_most("missing", mean.missing, 0.00706);
  expect_at_most("rms_px", mean.rms_px, 0.456);
  expect_at_most("wrong_by_2", mean.wrong_by_2, 0.00104);
  expect_at_most("wrong_by_3", mean.wrong_by_3, 0.00009);
}

struct Pothole {
  const char* name;
  const char* calibration;
  double depth_px;             ///< the 80th percentile of the labelled pixels lies so far below the road
  double missing;              ///< share of the pixels without a disparity
  double before_px, after_px;  ///< 95 % of the road model's errors are below, before matching and after it
};

class PotholesRealData : public testing::TestWithParam<Pothole> {};

TEST_P(PotholesRealData, RoadIsFlatAndPotholeLiesBelow) {
  REQUIRE_DATA(folder, "potholes");
  const std::string file = std::string(GetParam().name) + ".png";
  const Frame left = io::read_frame((*folder / "left" / file).string());
  const Frame right = io::read_frame((*folder / "right" / file).string());
  const Frame label = io::read_frame((*folder / "label" / file).string());
  const auto calibration = io::read_calibration((*folder / GetParam().calibration).string());
  Pipeline pipeline(preset("default"), calibration.rectified);
  const FrameResult& result = pipeline.process(left.view(), right.view());
  ASSERT_TRUE(result.road.has_road()) << result.road.reason;
  EXPECT_TRUE(result.geometry.roll_observable);
  expect_at_most("missing", 1 - result.valid_share, GetParam().missing);

  // The robust plane of the dense map outside the label is the truth of the model found before matching.
  std::vector<DisparityPoint> road;
  std::vector<double> depths;
  const int channels = channel_count(label.order);
  for (int v = 0; v < label.height; v += 3) {
    for (int u = 0; u < label.width; u += 3) {
      const float d = result.disparity(u, v);
      if (std::isnan(d)) continue;
      const auto pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(label.width) + static_cast<std::size_t>(u);
      if (label.bytes[pixel * static_cast<std::size_t>(channels)] == 0) {
        road.push_back({static_cast<double>(u), static_cast<double>(v), d});
      } else {
        depths.push_back(result.delta_t - result.transformed(u, v));
      }
    }
  }
  const auto start = ransac_plane(road, 1.0);
  ASSERT_TRUE(start);
  const auto plane = fit_plane_irls(road, *start, 1.0, true, 100);
  ASSERT_TRUE(plane);
  expect_at_most("before_px", model_error(result.road.model, plane->plane, road).worst_of_95_percent,
                 GetParam().before_px);
  expect_at_most("after_px", model_error(result.geometry.plane, plane->plane, road).worst_of_95_percent,
                 GetParam().after_px);
  std::sort(depths.begin(), depths.end());
  const double deep = depths[depths.size() * 8 / 10];
  RecordProperty("depth_px", std::to_string(deep));
  EXPECT_GE(slack * deep, GetParam().depth_px);
}

INSTANTIATE_TEST_SUITE_P(Pairs, PotholesRealData,
                         testing::Values(Pothole{"p1_01", "calibration_p12.yaml", 23.08, 0.1108, 0.162, 0.0913},
                                         Pothole{"p1_05", "calibration_p12.yaml", 24.2, 0.1138, 0.105, 0.067},
                                         Pothole{"p1_12", "calibration_p12.yaml", 17.41, 0.1128, 0.0658, 0.0396},
                                         Pothole{"p2_17", "calibration_p12.yaml", 20.48, 0.1133, 0.417, 0.416},
                                         Pothole{"p3_03", "calibration_p3.yaml", 12.73, 0.1204, 0.0574, 0.0149}),
                         [](const auto& test) { return std::string(test.param.name); });

/// A part of a grey image.
ImageView<const std::int16_t> crop(const GreyImage& image, int u, int v, int width, int height) {
  return {image.row(v) + u, width, height, image.width()};
}

TEST(EngineRealData, WinnerAndSubPixelMatchReference) {
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
        const auto pixels = static_cast<double>(expected.winner.pixels());
        double same = 0, worst = 0, validities_differ = 0;
        for (int y = 0; y < expected.winner.height(); ++y) {
          for (int x = 0; x < expected.winner.width(); ++x) {
            if (expected.winner(x, y) != actual.winner(x, y)) continue;
            same += 1;
            const bool expected_none = std::isnan(expected.disparity(x, y));
            const bool actual_none = std::isnan(actual.disparity(x, y));
            validities_differ += expected_none != actual_none ? 1 : 0;
            if (expected_none || actual_none) continue;
            worst = std::max(worst, std::abs(double{expected.disparity(x, y)} - actual.disparity(x, y)));
          }
        }
        const std::string place = info.name + "_" + name + "_" + std::to_string(u) + "_";
        RecordProperty(place + "same", std::to_string(same / pixels));
        RecordProperty(place + "worst_px", std::to_string(worst));
        EXPECT_GE(same / pixels, 0.999) << info.name << " " << name;
        EXPECT_LE(validities_differ / pixels, 0.001) << info.name << " " << name;
        EXPECT_LE(worst, 0.01) << info.name << " " << name;
      }
    }
  }
}

struct SceneFigures {
  const char* scene;
  double missing;     ///< share of the image without a disparity
  double wrong_by_2;  ///< share of the disparities with a truth that are wrong by more than 2 px
};

class MiddleburyRealData : public testing::TestWithParam<SceneFigures> {};

TEST_P(MiddleburyRealData, GeneralSceneHasDisparities) {
  REQUIRE_DATA(folder, "middlebury");
  const std::filesystem::path scene = *folder / GetParam().scene;
  const Frame left = io::read_frame((scene / "im0.png").string());
  const Frame right = io::read_frame((scene / "im1.png").string());
  const Image<float> truth = io::read_disparity((scene / "disp0GT.pfm").string());
  PipelineOptions options = preset("default");
  options.perspective.enabled = false;  // no road here
  options.perspective.disparities = 70;
  Pipeline pipeline(options);
  const FrameResult& result = pipeline.process(left.view(), right.view());
  double valid = 0, wrong = 0;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      const double error = std::abs(result.disparity(u, v) - truth(u, v));
      if (std::isnan(error)) continue;
      valid += 1;
      wrong += error > 2;
    }
  }
  expect_at_most("missing", 1 - valid / static_cast<double>(truth.pixels()), GetParam().missing);
  expect_at_most("wrong_by_2", wrong / valid, GetParam().wrong_by_2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MiddleburyRealData,
                         testing::Values(SceneFigures{"Motorcycle", 0.0554, 0.1203},
                                         SceneFigures{"PlaytableP", 0.0974, 0.2002}),
                         [](const auto& test) { return std::string(test.param.scene); });

}  // namespace
}  // namespace roadstereo

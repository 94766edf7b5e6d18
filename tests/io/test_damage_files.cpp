#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_files.hpp"
#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/damage_table.hpp"
#include "roadstereo/io/image_file.hpp"
#include "tests/damage/damage_from_truth.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t max_bytes = 6U << 20U;

/// Two potholes and a bump, small.
const synth::SyntheticPair& road() {
  static const synth::SyntheticPair pair = [] {
    synth::Scene scene = synth::named_scene("demo");
    scene.rig.width = 480;
    scene.rig.height = 270;
    scene.rig.focal_px = 320;
    scene.road.camber = 0;
    scene.road.cracks.clear();
    return synth::render(scene);
  }();
  return pair;
}

DamageReportInput report_input(const TrueDamage& truth) {
  DamageReportInput input{truth.map};
  input.left = road().left.view();
  input.transformed = truth.transformed;
  input.title = "frame 1";
  if (truth.map.metric) {
    input.disparity = truth.disparity;
    input.calibration = road().calibration;
  }
  return input;
}

/// Lines of a table without quotes; every line must end with CRLF.
std::vector<std::vector<std::string>> csv_lines(const std::string& text) {
  EXPECT_EQ(text.find('"'), std::string::npos);
  EXPECT_TRUE(text.ends_with("\r\n"));
  std::vector<std::vector<std::string>> lines;
  std::istringstream rest(text);
  for (std::string line; std::getline(rest, line);) {
    EXPECT_TRUE(line.ends_with('\r')) << line;
    line.back() = ',';
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    lines.push_back(cells);
  }
  return lines;
}

std::vector<std::string> keys(const Json& row) {
  std::vector<std::string> names;
  for (const auto& [name, value] : row.items()) names.push_back(name);
  return names;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

const std::set<std::string> metric_names{
    "area_m2",   "area_m2_stderr", "max_depth_m",  "max_depth_m_stderr",  "mean_depth_m",
    "volume_m3", "length_m",       "width_m",      "mean_depth_m_stderr", "volume_m3_stderr",
    "angle_deg", "diameter_m",     "centroid_x_m", "centroid_y_m",        "centroid_z_m",
    "road_x_m",  "road_y_m",       "distance_m",   "resolvable_depth_m",  "p_minor",
    "p_low",     "p_medium",       "p_high",       "wall_slope",          "quantity",
    "unit",      "severity_range"};

TEST(DamageTables, HoldEveryFigure) {
  const TrueDamage truth = damage_from_truth(road());
  ASSERT_EQ(truth.map.damages.size(), 3U);
  const Json document = Json::parse(damages_json(truth.map));
  EXPECT_EQ(document["metric"], true);
  EXPECT_TRUE(document["non_metric_reason"].is_null());
  EXPECT_EQ(document["size"]["width"], 480);
  const Json& rows = document["damages"];
  ASSERT_EQ(rows.size(), 3U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& known = road().damages[static_cast<std::size_t>(rows[i]["id"].get<int>() - 1)];
    EXPECT_EQ(rows[i]["kind"], known.kind == "bump" ? "protrusion" : "depression");
    EXPECT_EQ(rows[i]["area_m2"], known.area_m2);
    EXPECT_EQ(rows[i]["max_depth_m"], known.depth_m);
    EXPECT_EQ(rows[i]["volume_m3"], known.volume_m3);
    // The rig stands at x = -0.35 and is rolled, so that its axes are turned against those of the scene.
    EXPECT_NEAR(std::hypot(rows[i]["road_x_m"].get<double>(), rows[i]["road_y_m"].get<double>()),
                std::hypot(known.x_m + 0.35, known.y_m), 0.03);
    EXPECT_NEAR(rows[i]["angle_deg"].get<double>(), truth.map.damages[i].metrics->angle_rad * 57.29577951308232, 1e-9);
    EXPECT_EQ(rows[i]["deepest_u_px"], truth.map.damages[i].deepest_px[0]);
    EXPECT_EQ(rows[i]["box_v1_px"], truth.map.damages[i].box_px[3]);
  }
  EXPECT_GE(rows[0]["max_depth_m"], rows[1]["max_depth_m"]);
  EXPECT_EQ(rows[0]["severity"], "high");  // 75 mm deep, some 60 cm wide
}

TEST(DamageTables, JsonAndCsvAgree) {
  const TrueDamage truth = damage_from_truth(road());
  const Json document = Json::parse(damages_json(truth.map));
  const auto lines = csv_lines(damages_csv(truth.map));
  ASSERT_EQ(lines.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& row = document["damages"][i];
    EXPECT_EQ(keys(row), lines[0]);
    ASSERT_EQ(lines[i + 1].size(), lines[0].size());
    for (std::size_t k = 0; k < lines[0].size(); ++k) {
      const Json& value = row[lines[0][k]];
      const std::string& cell = lines[i + 1][k];
      if (value.is_number()) {
        EXPECT_EQ(std::strtod(cell.c_str(), nullptr), value.get<double>()) << lines[0][k];
      } else {
        const std::string text = value.is_null() ? "" : value.dump();
        EXPECT_EQ(cell, value.is_string() ? value.get<std::string>() : text) << lines[0][k];
      }
    }
  }
}

TEST(DamageTables, UncalibratedOmitMetresWithReason) {
  const TrueDamage truth = damage_from_truth(road(), false);
  const Json document = Json::parse(damages_json(truth.map));
  EXPECT_EQ(document["metric"], false);
  EXPECT_EQ(document["non_metric_reason"], "no calibration was given");
  const auto lines = csv_lines(damages_csv(truth.map));
  const Json& row = document["damages"][0];
  std::size_t metric = 0;
  for (std::size_t k = 0; k < lines[0].size(); ++k) {
    const bool is_metric = metric_names.count(lines[0][k]) > 0;
    const bool needs_right_image =
        lines[0][k] == "surface_significance" || lines[0][k] == "range_vote" || lines[0][k] == "specular_excess";
    const bool needs_image = lines[0][k] == "texture_share";
    const bool needs_sigma = lines[0][k] == "pixel_significance";
    const bool needs_metres = lines[0][k] == "extent";
    const bool expected_empty = is_metric || needs_right_image || needs_image || needs_sigma || needs_metres;
    metric += is_metric ? 1 : 0;
    EXPECT_EQ(row[lines[0][k]].is_null(), expected_empty) << lines[0][k];
    EXPECT_EQ(lines[1][k].empty(), expected_empty) << lines[0][k];
  }
  EXPECT_EQ(metric, metric_names.size());
  EXPECT_EQ(row["severity"], "unknown");
  EXPECT_GT(row["max_depth_px"], 0.3);
}

TEST(DamageTables, NoDamageStillHasColumns) {
  DamageMap map;
  map.ids.assign(40, 30, 0);
  map.metric = true;
  const auto lines = csv_lines(damages_csv(map));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].front(), "id");
  EXPECT_EQ(lines[0].back(), "ends_search");
  const Json document = Json::parse(damages_json(map));
  EXPECT_TRUE(document["damages"].is_array());
  EXPECT_TRUE(document["damages"].empty());
}

TEST(DamageTables, NeverHoldNan) {
  TrueDamage truth = damage_from_truth(road());
  DamageMetrics& metrics = *truth.map.damages[1].metrics;
  metrics.volume_m3 = {std::numeric_limits<double>::infinity(), std::nan("")};
  metrics.centroid_m[2] = -std::numeric_limits<double>::infinity();
  truth.map.noise_px = std::nan("");
  const std::string text = damages_json(truth.map);
  const Json document = Json::parse(text);
  EXPECT_TRUE(document["noise_px"].is_null());
  for (const char* name : {"volume_m3", "volume_m3_stderr", "centroid_z_m"}) {
    EXPECT_TRUE(document["damages"][1][name].is_null()) << name;
  }
  const std::string csv = damages_csv(truth.map);
  EXPECT_EQ(csv.find("inf"), std::string::npos);
  EXPECT_EQ(csv.find("nan"), std::string::npos);
}

int distance(const cv::Vec3b& a, const cv::Vec3b& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

cv::Vec3b pixel(const Frame& frame, int u, int v) {
  const auto at = static_cast<std::size_t>(v * frame.width + u) * 3;
  return {frame.bytes[at], frame.bytes[at + 1], frame.bytes[at + 2]};
}

/// 16-bit samples of one value, but for the last.
Frame wide_frame(int width, int height, unsigned sample, unsigned last) {
  Frame frame{{}, width, height, SampleType::u16};
  for (int i = 0; i < width * height; ++i) {
    const unsigned value = i + 1 < width * height ? sample : last;
    frame.bytes.push_back(static_cast<std::uint8_t>(value & 255U));
    frame.bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  }
  return frame;
}

TEST(DamageOverlay, OutlinesHaveColourOfSeverity) {
  const TrueDamage truth = damage_from_truth(road());
  const Frame overlay = damage_overlay(road().left.view(), 0, truth.map);
  ASSERT_EQ(overlay.width, 480);
  ASSERT_EQ(overlay.height, 270);
  const Damage& deepest = truth.map.damages.front();
  const cv::Vec3b red(40, 39, 214);
  int on_outline = 0, red_pixels = 0;
  for (int v = 1; v < 269; ++v) {
    for (int u = 1; u < 479; ++u) {
      const bool in = truth.map.ids(u, v) == deepest.id;
      const bool edge = in && (truth.map.ids(u - 1, v) != deepest.id || truth.map.ids(u, v - 1) != deepest.id ||
                               truth.map.ids(u + 1, v) != deepest.id || truth.map.ids(u, v + 1) != deepest.id);
      if (!edge) continue;
      ++on_outline;
      if (distance(pixel(overlay, u, v), red) < 90) ++red_pixels;
    }
  }
  EXPECT_GT(on_outline, 50);
  EXPECT_GT(red_pixels, 0.7 * on_outline);
  const auto [u, v] = deepest.deepest_px;
  const std::uint8_t grey = road().left.bytes[static_cast<std::size_t>(v * 480 + u)];
  EXPECT_EQ(pixel(overlay, u, v), cv::Vec3b(grey, grey, grey)) << "the inside stays as it is";
}

TEST(DamageOverlay, LineWidthGrowsWithImage) {
  const auto coloured_share = [](int scale) {
    DamageMap map;
    map.ids.assign(300 * scale, 200 * scale, 0);
    Damage damage;
    damage.id = 1;
    damage.box_px = {100 * scale, 60 * scale, 200 * scale, 140 * scale};
    for (int v = 60 * scale; v <= 140 * scale; ++v) std::fill_n(map.ids.row(v) + 100 * scale, 100 * scale + 1, 1);
    map.damages.push_back(damage);
    Frame grey{std::vector<std::uint8_t>(map.ids.pixels(), 128), 300 * scale, 200 * scale};
    const Frame overlay = damage_overlay(grey.view(), 0, map);
    int coloured = 0;
    for (int v = 0; v < overlay.height; ++v) {
      for (int u = 0; u < overlay.width; ++u) coloured += distance(pixel(overlay, u, v), {70, 70, 225}) < 60 ? 1 : 0;
    }
    return static_cast<double>(coloured) / static_cast<double>(map.ids.pixels());
  };
  // A line of one width would cover a tenth as much of the picture that is ten times as large.
  EXPECT_GT(coloured_share(10), 0.35 * coloured_share(1));
}

TEST(DamageOverlay, RejectsImageOfOtherSize) {
  const TrueDamage truth = damage_from_truth(road());
  const Frame small{std::vector<std::uint8_t>(100 * 100), 100, 100};
  EXPECT_THROW(damage_overlay(small.view(), 0, truth.map), Error);
}

/// 12 bits in 16: samples of 468 are 468 · 255 / 4095 = 29, also in a frame with a pixel that 10 bits do not hold.
TEST(DamageOverlay, WhiteIsThatOfProcessing) {
  for (const unsigned brightest : {468U, 1100U}) {
    const Frame frame = wide_frame(64, 48, 468, brightest);
    DamageMap map = make_empty_damage_map(64, 48, "");
    EXPECT_EQ(pixel(damage_overlay(frame.view(), 4095, map), 5, 5), cv::Vec3b(29, 29, 29)) << brightest;
    DamageReportInput input{map};
    input.left = frame.view();
    input.white_level = 4095;
    EXPECT_EQ(pixel(damage_background(input), 5, 5), cv::Vec3b(29, 29, 29)) << brightest;
  }
}

TEST(DamageReport, EscapesText) {
  const TrueDamage truth = damage_from_truth(road());
  DamageReportInput input = report_input(truth);
  input.title = "<script>alert('x')</script> & \"more\" {{&damages}}";
  input.properties = {{"<b>name</b>", "a < b & c"}};
  const std::string html = damage_report(input);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("<b>name"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;more&quot; {{&amp;damages}}"),
            std::string::npos);
  EXPECT_NE(html.find("<dt>&lt;b&gt;name&lt;/b&gt;</dt><dd>a &lt; b &amp; c</dd>"), std::string::npos);
}

TEST(DamageReport, HasNoExternalReferences) {
  const TrueDamage truth = damage_from_truth(road());
  const std::string html = damage_report(report_input(truth));
  for (const char* address : {"http:", "https:", "file:", "@import", "<link rel=\"stylesheet", "<script src"}) {
    EXPECT_EQ(html.find(address), std::string::npos) << address;
  }
  EXPECT_EQ(occurrences(html, "src=\""), occurrences(html, "src=\"data:image/"));
  EXPECT_EQ(occurrences(html, "href=\""), occurrences(html, "href=\"data:") + occurrences(html, "href=\"#damage-"));
  EXPECT_EQ(occurrences(html, "<canvas"), 3U);
  EXPECT_EQ(occurrences(html, "class=\"damage\""), 3U);
  EXPECT_EQ(occurrences(html, "aria-sort"), 10U + occurrences(html, "\"aria-sort\"") + 2U);  // heads; script; style
}

TEST(DamageReport, ShowsFiguresWithStandardErrors) {
  TrueDamage truth = damage_from_truth(road());
  truth.map.damages.resize(1);
  truth.map.damages[0].metrics->max_depth_m = {0.04518, 0.00131};
  truth.map.damages[0].metrics->volume_m3 = {0.012345, 0.0005};
  const std::string html = damage_report(report_input(truth));
  EXPECT_NE(html.find("45.2\u00a0±\u00a01.3\u00a0mm"), std::string::npos);
  EXPECT_NE(html.find("12.3\u00a0±\u00a00.5\u00a0L"), std::string::npos);
}

TEST(DamageReport, WithoutRoadNothingWasInspected) {
  TrueDamage truth = damage_from_truth(road());
  truth.map = make_empty_damage_map(480, 270, "no road was found");
  const std::string html = damage_report(report_input(truth));
  EXPECT_EQ(html.find("No damage found"), std::string::npos);
  EXPECT_NE(html.find("Not inspected"), std::string::npos);
  EXPECT_NE(html.find("no road was found"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(damages_json(truth.map))["noise_px"].is_null());
}

TEST(DamageReport, SaysThatNoDamageWasFound) {
  TrueDamage truth = damage_from_truth(road());
  truth.map.damages.clear();
  truth.map.ids.assign(480, 270, 0);
  const std::string html = damage_report(report_input(truth));
  EXPECT_NE(html.find("No damage found"), std::string::npos);
  EXPECT_EQ(html.find("<table"), std::string::npos);
  EXPECT_EQ(html.find("<canvas"), std::string::npos);
}

/// A road without damage is praised only where nothing casts doubt on it, and with the limit.
TEST(DamageReport, PraisesOnlyWhatWasInspectedReliably) {
  TrueDamage truth = damage_from_truth(road());
  truth.map.damages.clear();
  truth.map.ids.assign(480, 270, 0);
  DamageReportInput input = report_input(truth);
  input.limits.limit = "a depth of about 6 mm";
  const std::string good = damage_report(input);
  EXPECT_NE(good.find("notice good"), std::string::npos);
  EXPECT_NE(good.find("The limit is a depth of about 6 mm."), std::string::npos);
  input.warnings = {"blur: the pictures are <blurred>", "no code at all"};
  const std::string flawed = damage_report(input);
  EXPECT_EQ(flawed.find("notice good"), std::string::npos);
  EXPECT_NE(flawed.find("<strong>Warning (blur):</strong> the pictures are &lt;blurred&gt;.</p>"), std::string::npos);
  EXPECT_NE(flawed.find("<strong>Warning:</strong> no code at all.</p>"), std::string::npos);
  EXPECT_LT(flawed.find("the pictures are"), flawed.find("Appendix: processing")) << "at the top";
  input.warnings = {"row-error: the rows differ by 9 px"};
  input.limits.doubts = {"the rows differ by 9 px"};
  const std::string doubtful = damage_report(input);
  EXPECT_EQ(doubtful.find("notice good"), std::string::npos);
  EXPECT_NE(doubtful.find("not inspected reliably"), std::string::npos);
  EXPECT_EQ(occurrences(doubtful, "the rows differ by 9 px"), 1U) << "once, as the reason";
  EXPECT_EQ(doubtful.find("No part of the visible road"), std::string::npos);
}

TEST(DamageReport, UncalibratedIsInPixels) {
  const TrueDamage truth = damage_from_truth(road(), false);
  const std::string html = damage_report(report_input(truth));
  EXPECT_NE(html.find("no calibration was given"), std::string::npos);
  EXPECT_EQ(html.find("m²"), std::string::npos);
  EXPECT_EQ(html.find("\u00a0mm"), std::string::npos);
  EXPECT_EQ(html.find("along the road, m"), std::string::npos);
  EXPECT_EQ(html.find("ASTM"), std::string::npos);
  EXPECT_NE(html.find("along the image, px"), std::string::npos);
}

TEST(DamageReport, WithoutImageShowsTransformedMap) {
  const TrueDamage truth = damage_from_truth(road(), false);
  DamageReportInput input = report_input(truth);
  input.left = {};
  const Frame background = damage_background(input);
  ASSERT_EQ(background.width, 480);
  const auto& deepest = truth.map.damages.front().deepest_px;
  const cv::Vec3b in_hole = pixel(background, deepest[0], deepest[1]);
  EXPECT_GT(in_hole[2], 2 * in_hole[0]) << "red below the road";
  input.transformed = {};
  EXPECT_EQ(damage_background(input).height, 270);  // the depths themselves
  EXPECT_NO_THROW(damage_report(input));
}

TEST(DamageReport, HatchesInvalidPixels) {
  TrueDamage truth = damage_from_truth(road());
  const auto hatched = [&] {
    const std::string html = damage_report(report_input(truth));
    const std::string start = "fill=\"url(#hatch)\" d=\"";
    const std::size_t at = html.find(start) + start.size();
    return html.substr(at, html.find('"', at) - at);
  };
  EXPECT_EQ(hatched(), "");
  const auto [u, v] = truth.map.damages.front().deepest_px;
  const auto box = truth.map.damages.front().box_px;
  truth.disparity(u, v) = truth::nan_value;
  truth.disparity(u + 1, v) = truth::nan_value;
  // The crop begins a quarter of each side before the box and is not scaled.
  const int left = u - (box[0] - static_cast<int>(std::lround(0.25 * (box[2] - box[0] + 1))));
  const int top = v - (box[1] - static_cast<int>(std::lround(0.25 * (box[3] - box[1] + 1))));
  EXPECT_EQ(hatched(), "M" + std::to_string(left) + " " + std::to_string(top) + "h2v1h-2z");
}

std::vector<std::uint8_t> noise_sheet(int width, int height) {
  std::mt19937 random(1);
  Frame frame{std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3), width,
              height, SampleType::u8, ChannelOrder::bgr};
  std::generate(frame.bytes.begin(), frame.bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
  return encode_png(frame.view());
}

TEST(DamageReport, ShrinksLargeSheet) {
  const TrueDamage truth = damage_from_truth(road());
  DamageReportInput input = report_input(truth);
  input.sheet = noise_sheet(3000, 2200);
  ASSERT_GT(input.sheet.size(), 2 * max_bytes);
  const std::string html = damage_report(input);
  EXPECT_LT(html.size(), max_bytes);
  EXPECT_NE(html.find("Result sheet"), std::string::npos);
}

TEST(DamageReport, RejectsMapsOfOtherSize) {
  const TrueDamage truth = damage_from_truth(road());
  DamageReportInput input = report_input(truth);
  input.sheet = {1, 2, 3};
  EXPECT_THROW(damage_report(input), Error);
  const Image<float> small(10, 10);
  DamageReportInput with_small_disparity = report_input(truth);
  with_small_disparity.disparity = small;
  EXPECT_THROW(damage_report(with_small_disparity), Error);
  DamageReportInput with_small_map = report_input(truth);
  with_small_map.transformed = small;
  EXPECT_THROW(damage_report(with_small_map), Error);
}

/// A road with a grid of square damages, of noise all of it: the worst that pictures can be.
struct CrowdedRoad {
  TrueDamage truth;
  Frame image;

  CrowdedRoad(int columns, int rows, int cell) {
    const int width = columns * cell, height = rows * cell;
    truth = {{}, Image<float>(width, height), Image<float>(width, height, 30)};
    truth.map.ids.assign(width, height, 0);
    truth.map.road.assign(width, height, 255);
    truth.map.surface.assign(width, height, 30);
    truth.map.depth.assign(width, height, 0);
    truth.map.non_metric_reason = "made up";
    image = {std::vector<std::uint8_t>(truth.map.ids.pixels()), width, height};
    std::generate(image.bytes.begin(), image.bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
    for (int i = 0; i < columns * rows; ++i)
      add(i + 1, (i % columns) * cell + cell / 5, (i / columns) * cell + cell / 5, cell * 3 / 5);
  }

  void add(int id, int left, int top, int side) {
    Damage damage;
    damage.id = id;
    damage.box_px = {left, top, left + side - 1, top + side - 1};
    damage.deepest_px = {left + side / 2, top + side / 2};
    damage.centroid_px = {left + 0.5 * (side - 1), top + 0.5 * (side - 1)};
    damage.max_depth_px = {3, 0.1};
    for (int v = top; v < top + side; ++v) {
      for (int u = left; u < left + side; ++u) {
        truth.map.ids(u, v) = static_cast<std::uint16_t>(id);
        truth.map.depth(u, v) = static_cast<float>(random() % 1000) / 300;
        if (random() % 10 == 0) truth.transformed(u, v) = truth::nan_value;
      }
    }
    truth.map.damages.push_back(damage);
  }

  std::string report() const {
    DamageReportInput input{truth.map};
    input.left = image.view();
    input.transformed = truth.transformed;
    return damage_report(input);
  }

  std::mt19937 random{3};
};

TEST(DamageReport, ManyDamagesStayBelowSizeLimit) {
  const std::string html = CrowdedRoad(25, 20, 40).report();
  EXPECT_LT(html.size(), max_bytes);
  EXPECT_EQ(occurrences(html, "class=\"damage\""), 500U);
  EXPECT_EQ(occurrences(html, "<canvas"), 30U);
  EXPECT_NE(html.find("The 30 deepest of the 500 damages have a 3-D view"), std::string::npos);
}

TEST(DamageReport, LargeDamagesStayBelowSizeLimit) {
  const std::string html = CrowdedRoad(6, 5, 400).report();
  EXPECT_LT(html.size(), max_bytes);
  EXPECT_EQ(occurrences(html, "<canvas"), 30U);
  EXPECT_EQ(html.find("deepest of the"), std::string::npos);
}

TEST(DamageFiles, WritesEveryFileAndIds) {
  const fs::path folder = fs::path(testing::TempDir()) / "roadstereo_damage_files";
  fs::remove_all(folder);
  const TrueDamage truth = damage_from_truth(road());
  {
    OutputFolder output(folder);
    add_damage_files(output, report_input(truth));
    EXPECT_FALSE(fs::exists(folder / "report.html"));
    output.commit();
  }
  for (const char* name : {"damages.json", "damages.csv", "overlay.png", "report.html"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  const cv::Mat ids = cv::imread((folder / "damage.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(ids.type(), CV_16UC1);
  int different = 0;
  for (int v = 0; v < 270; ++v) {
    for (int u = 0; u < 480; ++u) different += ids.at<std::uint16_t>(v, u) != road().labels(u, v) ? 1 : 0;
  }
  EXPECT_EQ(different, 0);
  fs::remove_all(folder);
}

TEST(ReportFigures, RoundToStandardError) {
  const auto text = [](double value, double error) { return measured_text({value, error}, ""); };
  EXPECT_EQ(text(45.181, 1.31), "45.2\u00a0±\u00a01.3");
  EXPECT_EQ(text(45.181, 0.47), "45.2\u00a0±\u00a00.5");
  EXPECT_EQ(text(0.023456, 0.00111), "0.0235\u00a0±\u00a00.0011");
  EXPECT_EQ(text(1234.5, 56), "1234\u00a0±\u00a056");  // 1234.5 rounds to even
  EXPECT_EQ(text(45.181, 0), "45.2");
  EXPECT_EQ(text(45.181, std::nan("")), "45.2");
  EXPECT_EQ(text(45.181, 1e-9), "45.181\u00a0±\u00a00.000");
  EXPECT_EQ(text(std::nan(""), 1), "–");
  EXPECT_EQ(value_text(0.61234, "m"), "0.612\u00a0m");
  EXPECT_EQ(value_text(0, "m"), "0\u00a0m");
}

TEST(ReportMarkup, Base64FollowsRfc4648) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST(ReportMarkup, FillsPlaceholdersOnce) {
  EXPECT_EQ(fill("<{{a}}|{{&a}}>", {{"a", "{{b}}<i>"}}), "<{{b}}&lt;i&gt;|{{b}}<i>>");
  EXPECT_THROW(fill("{{missing}}", {}), Error);
  EXPECT_THROW(fill("{{open", {{"open", ""}}), Error);
}

}  // namespace
}  // namespace roadstereo::io

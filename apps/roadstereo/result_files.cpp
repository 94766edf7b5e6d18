#include "result_files.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>

#include "kitti_range.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/damage_report.hpp"
#include "roadstereo/io/damage_table.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/label_image.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/io/point_cloud.hpp"
#include "summary.hpp"

namespace roadstereo::cli {

namespace {

void add_kitti_png(Inspection& inspection, io::OutputFolder& folder) {
  const KittiRange range = fit_kitti_range(inspection.result.disparity);
  folder.add("disparity.png", io::encode_kitti_png(range.disparity));
  constexpr std::size_t worth_telling = 1000;  // one of so many
  if (worth_telling * range.lost <= range.valid) return;
  inspection.warnings.push_back(
      fmt::format("values-lost: {:.2f} % of the disparities are outside 0 … 255.99 px and invalid in disparity.png; "
                  "disparity.tiff has all of them",
                  100.0 * static_cast<double>(range.lost) / static_cast<double>(range.valid)));
}

void add_disparity(Inspection& inspection, io::OutputFolder& folder) {
  const FrameResult& result = inspection.result;
  folder.add("disparity.tiff", io::encode_float_tiff(result.disparity));
  add_kitti_png(inspection, folder);
  const io::ColourScale spread = io::percentile_scale(result.disparity, "disparity, px");
  folder.add("disparity_color.png", io::encode_png(io::colour_map(result.disparity, spread).view()));
}

void add_sigma(Inspection& inspection, io::OutputFolder& folder) {
  const Image<float>& sigma = inspection.result.sigma;
  if (sigma.empty()) return;  // of a given map
  folder.add("sigma.tiff", io::encode_float_tiff(sigma));
  const io::ColourScale errors = io::percentile_scale(sigma, "standard error, px");
  folder.add("sigma_color.png", io::encode_png(io::colour_map(sigma, errors).view()));
}

void add_transformed(Inspection& inspection, io::OutputFolder& folder) {
  const FrameResult& result = inspection.result;
  folder.add("transformed.tiff", io::encode_float_tiff(result.transformed));
  const io::ColourScale around_road = io::transformed_scale(result.transformed, result.delta_t);
  folder.add("transformed_color.png", io::encode_png(io::colour_map(result.transformed, around_road).view()));
}

/// Adds the point cloud in the camera frame and in road axes.
void add_clouds(Inspection& inspection, io::OutputFolder& folder) {
  if (!inspection.pair.calibration) return;
  const PointCloud cloud = cloud_from_disparity(inspection.result.disparity, inspection.pair.left.view(),
                                                inspection.options.white_level, *inspection.pair.calibration);
  folder.add("cloud.ply", io::encode_ply(cloud));
  if (!inspection.plane) return;
  folder.add("road_cloud.ply", io::encode_ply(to_road_axes(cloud, road_axes(*inspection.plane))));
}

std::string title_of(const Inspection& inspection) {
  return std::filesystem::path(inspection.files.left).filename().string();
}

std::optional<RollEstimate> known_geometry(const FrameResult& result) {
  if (!result.roll_found) return std::nullopt;
  return result.geometry;
}

std::vector<std::uint8_t> sheet_of(const Inspection& inspection) {
  const FrameResult& result = inspection.result;
  return io::encode_png(io::result_sheet(inspection.pair.left.view(), inspection.options.white_level, result.disparity,
                                         result.transformed, result.delta_t, known_geometry(result),
                                         title_of(inspection))
                            .view());
}

void add_damages(Inspection& inspection, io::OutputFolder& folder) {
  folder.add("damages.json", io::damages_json(inspection.damage));
  folder.add("damages.csv", io::damages_csv(inspection.damage));
  folder.add("damage.png", io::encode_label_png(inspection.damage.ids));
}

void add_overlay(Inspection& inspection, io::OutputFolder& folder) {
  io::DamageReportInput input{inspection.damage};
  input.left = inspection.pair.left.view();
  input.white_level = inspection.options.white_level;
  const Frame background = io::damage_background(input);
  folder.add("overlay.png", io::encode_png(io::damage_overlay(background.view(), 0, inspection.damage).view()));
}

void add_report(Inspection& inspection, io::OutputFolder& folder) {
  io::DamageReportInput report{inspection.damage};
  report.left = inspection.pair.left.view();
  report.white_level = inspection.options.white_level;
  report.disparity = inspection.result.disparity;
  report.transformed = inspection.result.transformed;
  report.calibration = inspection.pair.calibration;
  report.title = title_of(inspection.head, title_of(inspection));
  report.head = head_lines(inspection.head);
  report.severity = inspection.options.damage.severity;
  report.properties = summary_properties(inspection);
  report.sheet = sheet_of(inspection);
  report.warnings = inspection.warnings;
  report.limits = limits_of(inspection);
  folder.add("report.html", io::damage_report(report));
}

/// Files of one word of --write.
struct ResultGroup {
  const char* word;
  std::vector<std::pair<const char*, const char*>> files;  ///< name, what it is
  std::function<void(Inspection&, io::OutputFolder&)> add;
};

const std::vector<ResultGroup>& result_groups() {
  static const std::vector<ResultGroup> groups{
      {"disparity",
       {{"disparity.tiff", "disparities of the left image, px, float32, NaN invalid"},
        {"disparity.png", "the same as KITTI's: 16 bit, 1/256 px, 0 invalid"},
        {"disparity_color.png", "the same as a picture with its scale"}},
       add_disparity},
      {"sigma",
       {{"sigma.tiff", "standard errors of the disparities, px, float32, NaN invalid"},
        {"sigma_color.png", "the same as a picture with its scale"}},
       add_sigma},
      {"transformed",
       {{"transformed.tiff", "transformed disparities, px, float32: the intact road is delta_t, damage below"},
        {"transformed_color.png", "the same as a picture with its scale"}},
       add_transformed},
      {"sheet",
       {{"sheet.png",
         "left image, disparities, transformed disparities and v-disparity histogram with the road model"}},
       [](Inspection& inspection, io::OutputFolder& folder) { folder.add("sheet.png", sheet_of(inspection)); }},
      {"cloud",
       {{"cloud.ply", "points, camera frame (x right, y down, z forward), m"},
        {"road_cloud.ply", "points, the road is z = 0, m"}},
       add_clouds},
      {"damages",
       {{"damages.json", "damages and candidates, every measurement with its standard error"},
        {"damages.csv", "damages, one row each"},
        {"damage.png", "id of the damage at every pixel, 16 bit, 0: none"}},
       add_damages},
      {"overlay", {{"overlay.png", "left image with the outlines of the damages"}}, add_overlay},
      {"report", {{"report.html", "report to read or print, a single file"}}, add_report}};
  return groups;
}

}  // namespace

const std::vector<std::string>& result_words() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const ResultGroup& group : result_groups()) all.emplace_back(group.word);
    return all;
  }();
  return words;
}

void add_result_files(const std::vector<std::string>& words, Inspection& inspection, io::OutputFolder& folder) {
  for (const std::string& word : words) {
    if (std::find(result_words().begin(), result_words().end(), word) != result_words().end()) continue;
    fail("--write has \"", word, "\"; of a pair it can have: ", fmt::format("{}", fmt::join(result_words(), ", ")));
  }
  for (const ResultGroup& group : result_groups()) {
    if (words.empty() || std::find(words.begin(), words.end(), group.word) != words.end())
      group.add(inspection, folder);
    for (const auto& [name, what] : group.files) {
      if (folder.has(name)) {
        inspection.files_written.emplace_back(name, what);
      } else {
        folder.remove(name);
      }
    }
  }
}

}  // namespace roadstereo::cli

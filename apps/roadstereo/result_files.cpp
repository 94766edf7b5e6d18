#include "result_files.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "kitti_range.hpp"
#include "roadstereo/io/damage_files.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/io/point_cloud.hpp"
#include "summary.hpp"

namespace roadstereo::cli {

namespace {

void add_kitti_png(Inspection& inspection, io::OutputFolder& folder) {
  const KittiRange range = fit_kitti_range(inspection.result.disparity);
  folder.add("disparity.png", io::encode_kitti_png(range.disparity));
  if (range.lost == 0) return;
  inspection.warnings.push_back(
      fmt::format("{:.2f} % of the disparities are outside 0 … 255.99 px and invalid in disparity.png; "
                  "disparity.tiff has all of them",
                  100.0 * static_cast<double>(range.lost) / static_cast<double>(range.valid)));
}

void add_picture(io::OutputFolder& folder, const std::string& name, const Frame& picture) {
  folder.add(name, io::encode_png(picture.view()));
}

void add_sigma(ImageView<const float> sigma, io::OutputFolder& folder) {
  folder.add("sigma.tiff", io::encode_float_tiff(sigma));
  const io::ColourScale errors = io::percentile_scale(sigma, "standard error, px");
  add_picture(folder, "sigma_color.png", io::colour_map(sigma, errors));
}

/// Adds the point cloud in the camera frame and in road axes.
void add_clouds(const Inspection& inspection, io::OutputFolder& folder) {
  if (!inspection.pair.calibration) return;
  const io::PointCloud cloud = io::cloud_from_disparity(inspection.result.disparity, inspection.pair.left.view(),
                                                        inspection.options.white_level, *inspection.pair.calibration);
  folder.add("cloud.ply", io::encode_ply(cloud));
  if (!inspection.plane) return;
  folder.add("road_cloud.ply", io::encode_ply(io::to_road_axes(cloud, road_axes(*inspection.plane))));
}

std::optional<RollEstimate> known_geometry(const FrameResult& result) {
  if (!result.roll_found) return std::nullopt;
  return result.geometry;
}

}  // namespace

void add_result_files(Inspection& inspection, io::OutputFolder& folder) {
  const FrameResult& result = inspection.result;
  folder.add("disparity.tiff", io::encode_float_tiff(result.disparity));
  folder.add("transformed.tiff", io::encode_float_tiff(result.transformed));
  add_kitti_png(inspection, folder);
  const io::ColourScale spread = io::percentile_scale(result.disparity, "disparity, px");
  add_picture(folder, "disparity_color.png", io::colour_map(result.disparity, spread));
  if (!result.sigma.empty()) add_sigma(result.sigma, folder);
  const io::ColourScale around_road = io::transformed_scale(result.transformed, result.delta_t);
  add_picture(folder, "transformed_color.png", io::colour_map(result.transformed, around_road));
  const std::string title = std::filesystem::path(inspection.files.left).filename().string();
  const Frame sheet = io::result_sheet(inspection.pair.left.view(), result.disparity, result.transformed,
                                       result.delta_t, known_geometry(result), title);
  std::vector<std::uint8_t> sheet_bytes = io::encode_png(sheet.view());
  folder.add("sheet.png", sheet_bytes);
  add_clouds(inspection, folder);
  io::DamageReportInput report{inspection.damage};
  report.left = inspection.pair.left.view();
  report.disparity = result.disparity;
  report.transformed = result.transformed;
  report.calibration = inspection.pair.calibration;
  report.title = title;
  report.properties = summary_properties(inspection);
  report.sheet = std::move(sheet_bytes);
  io::add_damage_files(folder, report);
}

}  // namespace roadstereo::cli

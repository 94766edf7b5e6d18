#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "commands.hpp"
#include "core/degrees.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "image_size.hpp"
#include "io/plot.hpp"
#include "json_text.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "roadstereo/io/rectification.hpp"
#include "roadstereo/resolution_limits.hpp"

namespace roadstereo::cli {
namespace {

constexpr double mm = 1000;

/// Depth classes of potholes in ASTM D6433, metres.
constexpr std::array<double, 3> astm_depths_m{0.013, 0.025, 0.050};

struct LimitsArguments {
  std::vector<std::string> calibration;
  std::optional<double> focal_px, baseline_m;  ///< instead of a calibration
  double height_m = 0;
  double pitch_deg = 90;
  std::string size;
  ResolutionOptions resolution;
  int rows = 12;
  bool json = false;
  std::string figure;
};

/// The rig of the pictures after rectification, as `inspect` rectifies them.
StereoCalibration rectified_calibration(const io::StereoRig& rig, const LimitsArguments& arguments,
                                        const std::string& path) {
  ImageSize size{rig.width, rig.height};
  if (!arguments.size.empty()) size = parse_image_size("--size", arguments.size);
  if (size.width < 1) fail(path, " has no image size; set it with --size WIDTHxHEIGHT");
  try {
    return io::Rectifier(rig, size.width, size.height).calibration();
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    fail(path, ": ", error.what());
  }
}

StereoCalibration read_file(const LimitsArguments& arguments) {
  const std::string& path = arguments.calibration.front();
  io::CalibrationFile file =
      io::read_calibration(path, arguments.calibration.size() > 1 ? arguments.calibration[1] : "");
  if (!file.rigs.empty()) {
    if (arguments.size.empty()) fail(path, " has rigs of several sizes; choose one with --size WIDTHxHEIGHT");
    const ImageSize size = parse_image_size("--size", arguments.size);
    file.select_size(size.width, size.height, path);
  }
  return file.rectified ? *file.rectified : rectified_calibration(*file.rig, arguments, path);
}

/// The rig of the file, or of --focal-px and --baseline-m with the principal point in the middle of the image.
StereoCalibration read_rig(const LimitsArguments& arguments) {
  const bool from_file = !arguments.calibration.empty();
  const std::string name = from_file ? arguments.calibration.front() : "the rig of --focal-px";
  StereoCalibration calibration = from_file ? read_file(arguments) : StereoCalibration{};
  if (!arguments.size.empty()) {
    const ImageSize size = parse_image_size("--size", arguments.size);
    if (from_file) calibration.validate(size.width, size.height, name);
    calibration.width = size.width;
    calibration.height = size.height;
  }
  if (calibration.width < 1) fail(name, " has no image size; set it with --size WIDTHxHEIGHT");
  if (from_file) return calibration;
  calibration.focal_px = *arguments.focal_px;
  calibration.baseline_m = *arguments.baseline_m;
  calibration.cx_px = 0.5 * (calibration.width - 1);
  calibration.cy_px = 0.5 * (calibration.height - 1);
  return calibration;
}

Table row_table(const ResolutionLimits& limits, int rows) {
  Table table{"",
              {{"row", "row_px"},
               {"ahead m", "ahead_m"},
               {"distance m", "distance_m"},
               {"disparity px", "disparity_px"},
               {"1 px mm", "step_mm"},
               {"1 sigma mm", "std_error_mm"},
               {"pothole mm", "resolvable_depth_mm"},
               {"wide mm", "resolvable_width_mm"},
               {"rut mm", "resolvable_rut_mm"},
               {"GSD across mm", "gsd_across_mm"},
               {"along mm", "gsd_along_mm"},
               {"swath m", "swath_m"}},
              {}};
  for (const RowResolution& row : limits.rows(rows)) {
    const auto finite = [](double value) { return std::isfinite(value) ? value : std::nan(""); };
    table.rows.push_back({Cell(row.row_px, 0), Cell(row.ahead_m, 2), Cell(row.distance_m, 2), Cell(row.disparity_px, 1),
                          Cell(finite(mm * row.step_m), 1), Cell(mm * row.std_error_m, 2),
                          Cell(finite(mm * row.resolvable_depth_m), 1),
                          Cell(mm * 2 * std::sqrt(row.resolvable_area_m2 / std::numbers::pi), 0),
                          Cell(finite(mm * row.resolvable_rut_m), 1), Cell(mm * row.gsd_across_m, 2),
                          Cell(mm * row.gsd_along_m, 2), Cell(row.swath_m, 2)});
  }
  return table;
}

/// Describes where a depth class can be resolved.
std::string resolvable_text(const ResolutionLimits& limits, double depth_m) {
  const std::optional<RowResolution> farthest = limits.farthest(depth_m);
  const double highest = limits.max_camera_height_m(depth_m);
  const std::string from = highest > 0 ? fmt::format("; in the centre row up to a height of {:.2f} m", highest) : "";
  if (!farthest)
    return fmt::format("At this height {:.0f} mm cannot be resolved anywhere in the image{}.", mm * depth_m, from);
  if (farthest->row_px <= limits.first_row()) {
    return fmt::format("At this height {:.0f} mm can be resolved in the whole image, up to {:.2f} m from the camera{}.",
                       mm * depth_m, farthest->distance_m, from);
  }
  return fmt::format(
      "At this height {:.0f} mm can be resolved up to {:.2f} m ahead, {:.2f} m from the camera (row {:.0f}){}.",
      mm * depth_m, farthest->ahead_m, farthest->distance_m, farthest->row_px, from);
}

nlohmann::ordered_json limits_json(const LimitsArguments& arguments, const ResolutionLimits& limits) {
  nlohmann::ordered_json document = {{"height_m", arguments.height_m},
                                     {"pitch_deg", arguments.pitch_deg},
                                     {"noise_px", arguments.resolution.noise_px},
                                     {"threshold_sigma", arguments.resolution.threshold_sigma},
                                     {"rows", row_table(limits, arguments.rows).json()}};
  document["astm"] = nlohmann::ordered_json::array();
  for (const double depth : astm_depths_m) {
    const std::optional<RowResolution> farthest = limits.farthest(depth);
    document["astm"].push_back({{"depth_mm", mm * depth},
                                {"up_to_ahead_m", json_number(farthest ? farthest->ahead_m : std::nan(""))},
                                {"up_to_distance_m", json_number(farthest ? farthest->distance_m : std::nan(""))},
                                {"up_to_height_m", limits.max_camera_height_m(depth)}});
  }
  return document;
}

/// Plots depths over the distance on the road, with the depth classes of ASTM.
Frame limits_figure(const LimitsArguments& arguments, const ResolutionLimits& limits) {
  constexpr int points = 200;
  constexpr double max_mm = 1000;
  io::Curve step{"one pixel of disparity", {}, {}}, error{"one standard error", {}, {}},
      resolvable{"resolvable", {}, {}};
  for (const RowResolution& row : limits.rows(points)) {
    for (io::Curve* curve : {&step, &error, &resolvable}) curve->x.push_back(row.ahead_m);
    const auto shown = [&](double depth) { return mm * depth < max_mm ? mm * depth : std::nan(""); };
    step.y.push_back(shown(row.step_m));
    error.y.push_back(shown(row.std_error_m));
    resolvable.y.push_back(shown(row.resolvable_depth_m));
  }
  io::Panel panel{fmt::format("Height {:g} m, {:g} degrees below the horizon; lines: 13, 25, 50 mm (ASTM D6433)",
                              arguments.height_m, arguments.pitch_deg),
                  "ahead of the camera on the road, m",
                  "depth below the road, mm",
                  {step, error, resolvable},
                  true};
  for (const double depth : astm_depths_m) panel.horizontal_lines.push_back(mm * depth);
  constexpr double min_range_mm = 70;  // always shows the depth classes of ASTM
  double max_shown_mm = min_range_mm;
  for (const double depth : step.y) max_shown_mm = std::fmax(max_shown_mm, depth);
  panel.y_highest = max_shown_mm;
  constexpr int width = 900, height = 560;
  return io::draw_plot(panel, width, height);
}

void limits(LimitsArguments arguments) {
  const CameraPose pose{arguments.height_m, to_radians(arguments.pitch_deg)};
  const ResolutionLimits limits(read_rig(arguments), pose, arguments.resolution);
  if (!arguments.figure.empty()) write_figure(arguments.figure, limits_figure(arguments, limits));
  if (arguments.json) {
    fmt::print("{}", json_text(limits_json(arguments, limits)));
    return;
  }
  fmt::print("{}\n", row_table(limits, arguments.rows).text());
  for (const double depth : astm_depths_m) fmt::print("{}\n", resolvable_text(limits, depth));
  fmt::print(
      "Depths along the road normal, of potholes at least \"wide\", and the mean over ruts {:g} m wide and {:g} m "
      "long:\n"
      "{:g} standard errors of the noise of {:g} px and the sub-pixel bias of {:g} px. Swath: visible in both "
      "cameras.\n",
      arguments.resolution.rut_width_m, arguments.resolution.rut_length_m, arguments.resolution.threshold_sigma,
      arguments.resolution.noise_px, sub_pixel_bias_px);
}

constexpr const char* limits_footer =
    R"(Predicts the resolvable potholes and ruts of a rig per image row, from the nearest to the farthest, to plan a flight or
a mount. Assumes a planar road and no roll. A decrease of the disparity D by one pixel is a depth of height / (D - 1).

Examples:
  roadstereo limits --calibration calibration.yaml --height 2
  roadstereo limits --focal-px 700 --baseline-m 0.063 --size 1280x720 --height 2.5
  roadstereo limits --calibration calibration.yaml --height 1.6 --pitch 35 --noise-px 0.05 --figure limits.png)";

}  // namespace

void add_limits(CLI::App& app) {
  CLI::App* command = app.add_subcommand("limits", "Predict the smallest depth and area that a rig can resolve");
  command->footer(limits_footer);
  const auto arguments = std::make_shared<LimitsArguments>();
  auto* const rig = command->add_option_group("rig");
  rig->add_option("--calibration", arguments->calibration,
                  "Calibration of the rig; of raw cameras it is rectified; repeat for a ROS pair")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  auto* const focal = rig->add_option("--focal-px", arguments->focal_px,
                                      "Focal length, px, instead of a calibration; with --baseline-m and --size")
                          ->type_name("PX")
                          ->check(CLI::Range(1.0, 1e6));
  rig->require_option(1);
  auto* const baseline = command->add_option("--baseline-m", arguments->baseline_m, "Distance between the cameras, m")
                             ->type_name("M")
                             ->check(CLI::Range(0.001, 100.0))
                             ->needs(focal);
  focal->needs(baseline);
  command->add_option("--height", arguments->height_m, "Height of the camera above the road, m")
      ->type_name("M")
      ->required()
      ->check(CLI::Range(0.05, 1000.0));
  command->add_option("--pitch", arguments->pitch_deg, "Degrees below the horizon; 90: straight down")
      ->type_name("DEG")
      ->check(CLI::Range(-90.0, 90.0))
      ->capture_default_str();
  command
      ->add_option("--noise-px", arguments->resolution.noise_px,
                   "Noise of the intact road, px; noise_px in damages.json of inspect")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--threshold", arguments->resolution.threshold_sigma, "Resolvable depth in standard errors")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  command->add_option("--size", arguments->size, "Image size, if it is not in the calibration")
      ->type_name("WIDTHxHEIGHT");
  command->add_option("--rows", arguments->rows, "Number of rows of the table")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print JSON");
  command->add_option("--figure", arguments->figure, "Also plot the table to this PNG")->type_name("FILE");
  command->callback([arguments] { limits(*arguments); });
}

}  // namespace roadstereo::cli

#include "summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/degrees.hpp"
#include "inspection_limits.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

namespace {

std::string line(const std::string& title, const std::string& text) {
  return fmt::format("  {:<10}{}\n", title, text);
}

std::string pair_text(const Inspection& inspection) {
  const StereoPair& pair = inspection.pair;
  const std::string size = fmt::format("{}×{} px, ", pair.left.width, pair.left.height);
  if (!pair.calibration) return size + "no calibration: pixels only";
  return size + pair.calibration_format + (pair.rectified_here ? " calibration, rectified" : " calibration");
}

std::string engine_text(const Inspection& inspection) {
  if (inspection.engine.empty()) return "none: the disparities are those of " + inspection.files.disparity;
  return fmt::format("{}, {} thread{}, preset {}, {} disparities", inspection.engine, inspection.threads,
                     inspection.threads == 1 ? "" : "s", inspection.preset, inspection.result.shift.disparities);
}

std::string roll_text(const FrameResult& result) {
  if (result.road.status == RoadStatus::none) return "unknown: no road was found";
  if (!result.roll_found) return "unknown: too few pixels with a disparity";
  const RollEstimate& geometry = result.geometry;
  std::string angle =
      fmt::format("{:.3f}° ± {:.3f}°", to_degrees(geometry.roll_rad), to_degrees(geometry.roll_stderr_rad));
  if (geometry.roll_observable) return angle;
  return "not observable: the disparity of the road is nearly constant in the image (fitted " + angle + ")";
}

std::string term(double factor, char coordinate) {
  return fmt::format(" {} {:.5f} {}", factor < 0 ? "−" : "+", std::abs(factor), coordinate);
}

std::string road_text(const FrameResult& result) {
  if (result.road.status == RoadStatus::none) return "none: " + result.road.reason;
  if (!result.roll_found) return name_of(result.road.status);
  const DisparityPlane& plane = result.geometry.plane;
  return fmt::format("{}, d = {:.2f}{}{} px", name_of(result.road.status), plane.a0, term(plane.a1, 'v'),
                     term(plane.a2, 'u'));
}

std::string camera_text(const GroundPlane& plane) {
  return fmt::format("{:.3f} m above the road, optical axis {:.1f}° {} the horizon", plane.height_m,
                     to_degrees(std::abs(plane.pitch_rad)), plane.pitch_rad < 0 ? "above" : "below");
}

std::string spread_text(const FrameResult& result) {
  if (!result.roll_found) return "unknown";
  return fmt::format("{:.3f} px on the road, {:.3f} px on all pixels", result.spread.sigma_road_px,
                     result.spread.sigma_all_px);
}

std::string time_text(const FrameResult& result) {
  if (result.ms.match == 0) return fmt::format("{:.1f} ms without matching", result.ms.total);
  return fmt::format("{:.1f} ms ({:.0f} Mde/s), matching {:.1f} ms", result.ms.total, result.mde_per_s,
                     result.ms.match);
}

/// Names the report and the pictures that were written.
std::string picture_lines(const Inspection& inspection, const std::filesystem::path& folder) {
  std::string lines;
  const auto add = [&](const std::string& title, const char* name) {
    const bool is_written = std::any_of(inspection.files_written.begin(), inspection.files_written.end(),
                                        [name](const auto& file) { return file.first == name; });
    if (is_written) lines += line(title, (folder / name).string());
    return is_written;
  };
  add("report", "report.html");
  std::string title = "images";
  for (const char* name :
       {"overlay.png", "sheet.png", "disparity_color.png", "sigma_color.png", "transformed_color.png"}) {
    if (add(title, name)) title.clear();
  }
  return lines;
}

}  // namespace

io::InspectionLimits limits_of(const Inspection& inspection) {
  if (!inspection.damage.has_road()) return {};
  const FrameResult& result = inspection.result;
  RoadView view{result.geometry.plane, PairHealth::unknown, inspection.damage.noise_px, result.valid_share};
  if (inspection.plane) view.height_m = inspection.plane->height_m;
  const DamageOptions& options = inspection.options.damage;
  const int width = result.disparity.width(), height = result.disparity.height();
  std::optional<ResolvedDepth> depth;
  if (std::optional<StereoCalibration> sized = inspection.pair.calibration) {
    sized->width = width;
    sized->height = height;
    depth = resolved_depth(view, *sized, options);
  }
  return {doubts_of(inspection.health.findings(), view, width, height),
          limit_text(depth, inspection.damage.noise_px, options)};
}

std::string damage_text(const DamageMap& map, const io::InspectionLimits& limits) {
  if (!map.has_road()) return "not inspected: " + map.non_metric_reason;
  const std::string candidates = map.candidates.empty() ? ""
                                                        : fmt::format("; {} candidate{}", map.candidates.size(),
                                                                      map.candidates.size() == 1 ? "" : "s");
  if (map.damages.empty() && !limits.doubts.empty()) {
    return "none found" + candidates + ", but the road was not inspected reliably: " + limits.doubts.front();
  }
  if (map.damages.empty())
    return "none found" + candidates + (limits.limit.empty() ? "" : "; the limit is " + limits.limit);
  const auto depressions = std::count_if(map.damages.begin(), map.damages.end(),
                                         [](const Damage& one) { return one.kind == DamageKind::depression; });
  const auto protrusions = static_cast<std::ptrdiff_t>(map.damages.size()) - depressions;
  const Damage& first = map.damages.front();  // the depth or height of no other is larger
  const char* const most = first.kind == DamageKind::depression ? "deepest" : "highest";
  std::string text = fmt::format("{} depression{}, {} protrusion{}; ", depressions, depressions == 1 ? "" : "s",
                                 protrusions, protrusions == 1 ? "" : "s");
  if (first.metrics) {
    constexpr double mm = 1000;
    const DamageMetrics& metrics = *first.metrics;
    return text +
           fmt::format("{} {:.1f} ± {:.1f} mm, {:.0f} ± {:.0f} cm²", most, mm * metrics.max_depth_m.value,
                       mm * metrics.max_depth_m.std_error, 1e4 * metrics.area_m2.value,
                       1e4 * metrics.area_m2.std_error) +
           candidates;
  }
  return text + fmt::format("{} {:.2f} ± {:.2f} px", most, first.max_depth_px.value, first.max_depth_px.std_error) +
         candidates;
}

std::vector<std::pair<std::string, std::string>> summary_properties(const Inspection& inspection) {
  const FrameResult& result = inspection.result;
  std::vector<std::pair<std::string, std::string>> properties{
      {"Pair", pair_text(inspection)}, {"Roll", roll_text(result)}, {"Road", road_text(result)}};
  if (inspection.plane) properties.emplace_back("Camera", camera_text(*inspection.plane));
  properties.emplace_back("Pixels with a disparity", fmt::format("{:.1f} %", 100 * result.valid_share));
  properties.emplace_back("Standard deviation", spread_text(result));
  properties.emplace_back("Engine", engine_text(inspection));
  properties.emplace_back("Time", time_text(result));
  for (const std::string& warning : inspection.warnings) properties.emplace_back("Warning", warning);
  return properties;
}

std::string summary(const Inspection& inspection, const std::filesystem::path& folder) {
  const FrameResult& result = inspection.result;
  const PairFiles& files = inspection.files;
  const std::string images = files.right.empty() ? files.left : files.left + " + " + files.right;
  std::string text = fmt::format("roadstereo {}: {}\n", version, images);
  text += line("pair", pair_text(inspection));
  text += line("engine", engine_text(inspection));
  text += line("roll", roll_text(result));
  text += line("road", road_text(result));
  if (inspection.plane) text += line("camera", camera_text(*inspection.plane));
  text += line("valid", fmt::format("{:.1f} % of the pixels", 100 * result.valid_share));
  text += line("sigma_d", spread_text(result));
  text += line("damage", damage_text(inspection.damage, limits_of(inspection)));
  text += line("time", time_text(result));
  for (const std::string& warning : inspection.warnings) text += line("warning", warning);
  return text + picture_lines(inspection, folder);
}

}  // namespace roadstereo::cli

#include "live/status_json.hpp"

#include <cmath>

#include "core/degrees.hpp"
#include "health_json.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

using nlohmann::ordered_json;

ordered_json measurement_json(const Measurement& measured, double scale, const char* unit) {
  return {{"value", json_number(scale * measured.value)},
          {"error", json_number(scale * measured.std_error)},
          {"unit", unit}};
}

ordered_json damage_json(const ListedDamage& listed) {
  const Damage& damage = listed.best;
  ordered_json json{{"id", listed.id},
                    {"time_s", listed.first_seen_s},
                    {"views", listed.views},
                    {"kind", name_of(damage.kind)},
                    {"cut", damage.cut_by_border}};
  if (damage.metrics) {
    constexpr double mm = 1000;        // in a metre
    constexpr double cm2 = 100 * 100;  // in a square metre
    json["severity"] = name_of(damage.metrics->severity);
    json["depth"] = measurement_json(damage.metrics->max_depth_m, mm, "mm");
    json["area"] = measurement_json(damage.metrics->area_m2, cm2, "cm²");
    return json;
  }
  json["severity"] = nullptr;
  json["depth"] = measurement_json(damage.max_depth_px, 1, "px");
  json["area"] = {{"value", damage.pixels}, {"error", nullptr}, {"unit", "px²"}};
  return json;
}

ordered_json roll_json(const LiveView& view) {
  if (!view.geometry) return nullptr;
  return {{"degrees", json_number(to_degrees(view.geometry->roll_rad))},
          {"error_degrees", json_number(to_degrees(view.geometry->roll_stderr_rad))},
          {"observable", view.geometry->roll_observable}};
}

/// Of the view, with what only the last pairs together show.
ordered_json health_of(const LiveView& view, const RecentHealth& recent) {
  ordered_json json = health_json(view.health);
  for (const ordered_json& finding : findings_json(recent.findings())) json["findings"].push_back(finding);
  json["vibration_px"] = json_number(recent.vibration_px());
  json["lost_share"] = json_number(recent.lost_share());
  return json;
}

ordered_json view_json(const LiveView& view, const RecentHealth& recent) {
  ordered_json json{{"name", view.name},
                    {"width", view.left.width},
                    {"height", view.left.height},
                    {"latency_ms", json_number(view.latency_ms)},
                    {"roll", roll_json(view)},
                    {"height_m", nullptr},
                    {"pitch_degrees", nullptr},
                    {"damages", view.damages.size()},
                    {"health", health_of(view, recent)},
                    {"warnings", view.warnings}};
  for (const HealthFinding& finding : recent.findings()) json["warnings"].push_back(finding.id + ": " + finding.text);
  if (view.plane) {
    json["height_m"] = json_number(view.plane->height_m);
    json["pitch_degrees"] = json_number(to_degrees(view.plane->pitch_rad));
  }
  return json;
}

ordered_json recording_json(const RecordingState& recording) {
  if (!recording.on) return nullptr;
  return {{"recorded", recording.recorded}, {"skipped", recording.skipped}, {"message", recording.message}};
}

ordered_json path_json(const LivePath& path) {
  constexpr double mm = 1000;  // in a metre
  ordered_json points = ordered_json::array();
  for (const auto& [x, y] : path.points_m) points.push_back({std::round(mm * x) / mm, std::round(mm * y) / mm});
  return {{"points_m", points},
          {"heading_degrees", json_number(to_degrees(path.heading_rad))},
          {"length_m", json_number(path.length_m)},
          {"pieces", path.pieces}};
}

}  // namespace

ordered_json counts_json(const LiveCounts& counts) {
  return {{"taken", counts.taken},     {"processed", counts.shown},   {"dropped", counts.dropped},
          {"too_old", counts.too_old}, {"rejected", counts.rejected}, {"reconnects", counts.reconnects}};
}

ordered_json latency_json(const LatencyStatistics& latency) {
  return {{"median", json_number(latency.median_ms)},
          {"p95", json_number(latency.p95_ms)},
          {"max", json_number(latency.max_ms)}};
}

ordered_json status_json(const LiveStatus& status, double max_age_s) {
  ordered_json json{{"state", name_of(status.state)},
                    {"message", status.message},
                    {"frame", status.view ? status.view->number : 0},
                    {"age_s", json_number(status.age_s)},
                    {"max_age_s", max_age_s},
                    {"fps", json_number(status.fps)},
                    {"latency_ms", latency_json(status.latency)},
                    {"counts", counts_json(status.counts)},
                    {"recording", recording_json(status.recording)},
                    {"path", nullptr},
                    {"view", nullptr},
                    {"damages_found", status.damages_found},
                    {"damages", ordered_json::array()}};
  if (status.view) json["view"] = view_json(*status.view, status.health);
  if (status.path) json["path"] = path_json(*status.path);
  for (const ListedDamage& listed : status.damages) json["damages"].push_back(damage_json(listed));
  return json;
}

}  // namespace roadstereo::cli

#include "flight/flight_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "auto_mask.hpp"
#include "finite_values.hpp"
#include "health_json.hpp"
#include "json_text.hpp"
#include "result_json.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Minimum, median and maximum of the finite values.
Json range_json(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }),
               values.end());
  if (values.empty()) return nullptr;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  Json range = {{"min", *smallest}, {"median", 0}, {"max", *largest}};
  range["median"] = median(values);
  return range;
}

Json frames_json(const FlightSummary& summary) {
  return {{"total", summary.frames},
          {"good", summary.good},
          {"rejected", summary.rejected},
          {"failed", summary.failed},
          {"road_estimated", summary.road_estimated},
          {"road_unknown", summary.road_unknown},
          {"inspected", summary.inspected},
          {"located", summary.located ? Json(*summary.located) : Json(nullptr)},
          {"located_by_trajectory", summary.located ? Json(summary.located_by_trajectory) : Json(nullptr)},
          {"reasons", summary.reasons}};
}

Json damages_json(const FlightSummary& summary, const std::vector<io::RoadDamage>& damages, bool metric) {
  std::int64_t depressions = 0;
  Json severities = Json::object(), distresses = Json::object();
  for (const Severity severity : {Severity::high, Severity::medium, Severity::low, Severity::minor, Severity::uncertain,
                                  Severity::unresolvable, Severity::unknown}) {
    severities[name_of(severity)] = 0;
  }
  const auto count = [](Json& counts, const char* name) { counts[name] = counts.value(name, std::int64_t{0}) + 1; };
  for (const io::RoadDamage& damage : damages) {
    depressions += damage.best.kind == DamageKind::depression ? 1 : 0;
    if (!damage.best.metrics) continue;
    count(severities, name_of(damage.best.metrics->severity));
    count(distresses, name_of(damage.best.metrics->distress));
  }
  const auto all = static_cast<std::int64_t>(damages.size());
  return {{"total", all},
          {"depressions", depressions},
          {"protrusions", all - depressions},
          {"candidates", summary.candidates},
          {"sightings", summary.sightings},
          {"by_distress", metric ? distresses : Json(nullptr)},
          {"by_severity", metric ? severities : Json(nullptr)}};
}

Json run_json(const FlightRun& run) {
  return {{"complete", run.complete},
          {"seconds", json_number(run.seconds)},
          {"frames_per_second", json_number(run.frames_per_second)},
          {"resumed_at_frame", run.resumed_at},
          {"threads", run.threads}};
}

/// Medians of the frames, with what only successive frames show.
Json flight_health_json(const FlightHealth& health) {
  Json document = health_json(health.typical());
  document["findings"] = findings_json(health.findings());
  document["vibration_px"] = json_number(health.vibration_px());
  document["lost_share"] = json_number(health.lost_share());
  document["frames_with"] = health.frames_with();
  return document;
}

/// How the trajectory uses the track; null without --trajectory and a track.
Json track_json(const FlightRun& run) {
  if (!run.track && run.track_unused.empty()) return nullptr;
  Json track = {{"used", run.track.has_value()},
                {"unused_reason", run.track_unused.empty() ? Json(nullptr) : Json(run.track_unused)}};
  if (!run.track) return track;
  const TrackFit& fit = *run.track;
  track["rms_m"] = json_number(fit.rms_m);
  track["clocks_checked"] = fit.time_offset_found;
  track["time_offset_s"] = json_number(fit.time_offset_s.value);
  track["time_offset_stderr_s"] = json_number(fit.time_offset_s.std_error);
  track["lever_arm_m"] = track["lever_arm_stderr_m"] = Json::array();
  for (const Measurement& axis : fit.lever_arm_m) {
    track["lever_arm_m"].push_back(json_number(axis.value));
    track["lever_arm_stderr_m"].push_back(json_number(axis.std_error));
  }
  return track;
}

Json rig_bias_json(const RigBias& bias) {
  const bool found = bias.order > 0;
  return {{"frames", bias.frames},
          {"order", bias.order},
          {"rms_px", found ? json_number(bias.rms_px) : Json(nullptr)},
          {"rms_stderr_px", found ? json_number(bias.rms_std_error_px) : Json(nullptr)},
          {"file", found ? Json("rig_bias.json") : Json(nullptr)}};
}

/// What the run was made of, for commands that continue with it. Paths are relative to the output folder; what is no
/// file, such as a GStreamer pipeline, is as given.
Json inputs_json(const FlightSettings& settings, const io::StaticMaskRecord& static_mask) {
  const auto relative = [&](const std::string& name) {
    std::error_code absent;
    return std::filesystem::exists(name, absent) ? std::filesystem::proximate(name, settings.output).string() : name;
  };
  std::string mask = static_mask.applied ? static_mask_file : "";
  if (!settings.mask.empty()) mask = relative(settings.mask);
  Json source = Json::array(), calibration = Json::array();
  for (const std::string& name : settings.source) source.push_back(relative(name));
  for (const std::string& name : settings.calibration) calibration.push_back(relative(name));
  return {{"source", source},
          {"calibration", calibration},
          {"mask", mask},
          {"finds_white_level", !sets_white_level(settings.processing)},
          {"severity", settings.processing.severity == ProcessingSettings().severity
                           ? settings.processing.severity
                           : relative(settings.processing.severity)},
          {"rig_bias", settings.processing.rig_bias.empty() ? "" : relative(settings.processing.rig_bias)},
          {"layout", settings.source_settings.layout},
          {"topics", settings.source_settings.topics},
          {"max_time_difference_ms", settings.source_settings.max_time_difference_ms},
          {"rate_hz", settings.source_settings.rate_hz},
          {"track_offset_s", settings.track.offset_s}};
}

}  // namespace

std::string flight_json(const FlightSettings& settings, const FlightRun& run, const FlightSummary& summary,
                        const std::vector<io::RoadDamage>& damages) {
  Json document = {{"version", version}, {"source", settings.source}, {"source_kind", run.source}};
  document["calibration"] = settings.calibration.empty() ? Json(nullptr) : Json(settings.calibration);
  document["calibration_format"] = run.calibration_format.empty() ? Json(nullptr) : Json(run.calibration_format);
  document["inputs"] = inputs_json(settings, summary.static_mask);
  document["from"] = settings.from;
  document["to"] = settings.to ? Json(*settings.to) : Json(nullptr);
  document["every"] = settings.every;
  document["preset"] = settings.processing.preset;
  document["engine"] = run.engine;
  document["options"] = options_json(run.options);
  document["frames"] = frames_json(summary);
  document["static_mask"] = static_mask_json(summary.static_mask);
  document["first_time_s"] = json_number(summary.first_time_s);
  document["last_time_s"] = json_number(summary.last_time_s);
  document["damages"] = damages_json(summary, damages, !run.calibration_format.empty());
  document["roll_deg"] = range_json(summary.curves.roll_deg);
  document["height_m"] = range_json(summary.curves.height_m);
  document["sigma_d_px"] = range_json(summary.curves.sigma_d_px);
  document["valid_share"] = range_json(summary.valid_share);
  document["matching_ms"] = range_json(summary.matching_ms);
  document["damage_ms"] = range_json(summary.damage_ms);
  document["health"] = flight_health_json(summary.health);
  document["rig_bias"] = rig_bias_json(summary.rig_bias);
  document["crs"] = run.crs.empty() ? Json(nullptr) : Json(run.crs);
  document["path"] = run.path.empty() ? Json(nullptr) : Json(run.path);
  document["track"] = track_json(run);
  document["notices"] = run_notices(run, summary);
  document["run"] = run_json(run);
  return json_text(document);
}

}  // namespace roadstereo::cli

#include "live/live_summary.hpp"

#include <fmt/core.h>

#include "auto_mask.hpp"
#include "json_text.hpp"
#include "live/memory_use.hpp"
#include "live/status_json.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {
namespace {

double mean_fps(const LiveSummary& summary) {
  return summary.seconds > 0 ? static_cast<double>(summary.status.counts.shown) / summary.seconds : 0;
}

}  // namespace

std::string summary_text(const LiveSummary& summary) {
  const LiveCounts& counts = summary.status.counts;
  std::string text = fmt::format("roadstereo {}: {}\n", version, summary.source);
  text += fmt::format("  {:<10}{} taken, {} processed, {} dropped, {} too old, {} rejected\n", "pairs", counts.taken,
                      counts.shown, counts.dropped, counts.too_old, counts.rejected);
  text += fmt::format("  {:<10}{:.1f} frames/s over {:.1f} s\n", "rate", mean_fps(summary), summary.seconds);
  text += fmt::format("  {:<10}median {:.1f} ms, 95 %: {:.1f} ms, max {:.1f} ms\n", "latency",
                      summary.latency.median_ms, summary.latency.p95_ms, summary.latency.max_ms);
  text += fmt::format("  {:<10}{} found\n", "damages", summary.status.damages_found);
  const io::StaticMaskRecord& mask = summary.status.static_mask;
  if (mask.share > 0) text += fmt::format("  {:<10}{}\n", "mask", static_mask_text(mask));
  const RecordingState& recording = summary.status.recording;
  if (recording.on) {
    text += fmt::format("  {:<10}{} pairs, {} skipped{}{}\n", "recorded", recording.recorded, recording.skipped,
                        recording.message.empty() ? "" : "; ", recording.message);
  }
  if (const SharedPath& path = summary.status.path) {
    text += fmt::format(
        "  {:<10}{:.2f} m since the last of {} pieces began; odometry {:.1f} ms a frame, {:.0f} % of the time\n",
        "path", path->length_m, path->pieces, path->odometry_ms, 100 * path->share);
  }
  if (counts.reconnects > 0) text += fmt::format("  {:<10}reconnected {} times\n", "camera", counts.reconnects);
  return text;
}

std::string summary_json(const LiveSummary& summary) {
  const RecordingState& recording = summary.status.recording;
  nlohmann::ordered_json json{{"source", summary.source}, {"seconds", json_number(summary.seconds)}};
  json.update(counts_json(summary.status.counts));
  json["fps"] = json_number(mean_fps(summary));
  json["latency_ms"] = latency_json(summary.latency);
  json["recorded"] = recording.recorded;
  json["recording_skipped"] = recording.skipped;
  json["recording_message"] = recording.message;
  json["static_mask"] = static_mask_json(summary.status.static_mask);
  json["damages"] = summary.status.damages_found;
  const SharedPath& path = summary.status.path;
  json["path_m"] = path ? json_number(path->length_m) : nullptr;
  json["path_pieces"] = path ? nlohmann::ordered_json(path->pieces) : nullptr;
  json["odometry_ms"] = path ? json_number(path->odometry_ms) : nullptr;
  json["odometry_share"] = path ? json_number(path->share) : nullptr;
  json["peak_memory_mib"] = json_number(memory_use().peak_mib);
  json["memory_mib"] = json_number(memory_use().now_mib);
  return json_text(json);
}

}  // namespace roadstereo::cli

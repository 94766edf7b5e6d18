#include "flight/flight_results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "auto_mask.hpp"
#include "finite_values.hpp"
#include "flight/flight_json.hpp"
#include "io/geo/utc_time.hpp"
#include "roadstereo/io/flight_tables.hpp"
#include "roadstereo/io/rig_bias_file.hpp"
#include "roadstereo/io/road_segments.hpp"

namespace roadstereo::cli {

namespace {

std::string range_text(const std::vector<double>& values, const char* unit, int decimals) {
  std::vector<double> known;
  for (const double value : values) {
    if (std::isfinite(value)) known.push_back(value);
  }
  if (known.empty()) return "unknown";
  const double smallest = quantile(known, 0);
  const double largest = quantile(known, 1);
  return fmt::format("{:.{}f} {} (median; {:.{}f} … {:.{}f})", median(known), decimals, unit, smallest, decimals,
                     largest, decimals);
}

std::string frames_text(const FlightSummary& summary) {
  std::string text = fmt::format("{}", summary.frames);
  if (summary.rejected > 0) text += fmt::format(", {} of them rejected", summary.rejected);
  if (summary.failed > 0) text += fmt::format(", {} of them failed", summary.failed);
  return text;
}

std::string bias_text(const RigBias& bias) {
  if (bias.order == 0) return fmt::format("no significant field in {} frames", bias.frames);
  return fmt::format(
      "{:.3f} ± {:.3f} px (RMS over the road), degree {}, from {} frames; it may be the road's own shape", bias.rms_px,
      bias.rms_std_error_px, bias.order, bias.frames);
}

std::vector<std::pair<std::string, std::string>> properties_of(const FlightRun& run, const FlightSummary& summary) {
  std::vector<std::pair<std::string, std::string>> properties{{"Source", run.source}, {"Frames", frames_text(summary)}};
  properties.emplace_back("Damages", fmt::format("{} in {} sightings", summary.damages, summary.sightings));
  properties.emplace_back("Roll", range_text(summary.curves.roll_deg, "°", 2));
  if (!run.calibration_format.empty()) {
    properties.emplace_back("Height above the road", range_text(summary.curves.height_m, "m", 3));
  }
  properties.emplace_back("Standard deviation on the road", range_text(summary.curves.sigma_d_px, "px", 3));
  properties.emplace_back("Road model re-estimated",
                          fmt::format("in {} of {} frames", summary.road_estimated, summary.good));
  properties.emplace_back("Bias of the rig", bias_text(summary.rig_bias));
  properties.emplace_back("Time per frame",
                          fmt::format("{} matching, {} damage", range_text(summary.matching_ms, "ms", 1),
                                      range_text(summary.damage_ms, "ms", 1)));
  if (summary.located)
    properties.emplace_back("Frames with position",
                            fmt::format("{} of {} frames{}", *summary.located, summary.frames,
                                        summary.located_by_trajectory > 0 ? ", by the trajectory" : ""));
  if (!run.path.empty()) properties.emplace_back("Path", run.path);
  properties.emplace_back("Engine", fmt::format("{}, {} threads", run.engine, run.threads));
  return properties;
}

/// What contradicts --height or --pitch, with the tolerances of RigPrior; empty: nothing.
std::string pose_text(const FlightRun& run, const FlightSummary& summary) {
  constexpr double height_tolerance = 0.2, pitch_tolerance_deg = 5;
  const auto known = [](std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    return median(std::move(values));
  };
  const double height_m = known(summary.curves.height_m), pitch_deg = known(summary.pitch_deg);
  if (run.expected_height_m && std::abs(height_m / *run.expected_height_m - 1) > height_tolerance) {
    return fmt::format(
        "The camera is {:.2f} m (median) above the road, not {:g} m as expected; check the unit of the "
        "baseline in {}, or --height",
        height_m, *run.expected_height_m, run.calibration_file.empty() ? "the calibration" : run.calibration_file);
  }
  if (run.expected_pitch_deg && std::abs(pitch_deg - *run.expected_pitch_deg) > pitch_tolerance_deg) {
    return fmt::format(
        "The camera looks {:.1f}° (median) below the horizon of the road, not {:g}° as expected; check "
        "--pitch, and the principal point of the calibration",
        pitch_deg, *run.expected_pitch_deg);
  }
  return {};
}

/// What the track says of the clocks, where it is more than a second.
std::string clock_text(const FlightRun& run) {
  constexpr double max_offset_s = 1;
  if (!run.track || !run.track->time_offset_found || std::abs(run.track->time_offset_s.value) <= max_offset_s)
    return {};
  return fmt::format(
      "The clocks of camera and track differ: the times of the frames are corrected by {:+.3f} ± {:.3f} s, "
      "in addition to --track-offset",
      run.track->time_offset_s.value, run.track->time_offset_s.std_error);
}

}  // namespace

std::vector<std::string> run_notices(const FlightRun& run, const FlightSummary& summary) {
  std::vector<std::string> notices;
  const std::string unused =
      run.track_unused.empty() ? "" : "The trajectory does not use the track: " + run.track_unused;
  const std::string doubt = run.size_doubt.empty() ? "" : "Calibration " + run.size_doubt;
  for (const std::string& text : {doubt, pose_text(run, summary), clock_text(run), unused}) {
    if (!text.empty()) notices.push_back(text);
  }
  return notices;
}

namespace {

std::vector<std::string> notices_of(const FlightRun& run, const FlightSummary& summary) {
  std::vector<std::string> notices;
  for (const std::string& notice : run_notices(run, summary)) notices.push_back(notice + ".");
  if (!run.complete) notices.emplace_back("The flight was interrupted; continue it with inspect --resume.");
  if (!summary.no_position_reason.empty())
    notices.push_back("No frame has a position: " + summary.no_position_reason + ".");
  if (!summary.track_gaps.empty()) notices.push_back("Track: " + summary.track_gaps + ".");
  if (!summary.track_outliers.empty()) notices.push_back("Track: " + summary.track_outliers + ".");
  if (!run.no_map_reason.empty()) notices.push_back("There is no map: " + run.no_map_reason + ".");
  if (summary.static_mask.share > 0) {
    notices.push_back(static_mask_text(summary.static_mask) + " (" + static_mask_file + ").");
  }
  for (const HealthFinding& finding : summary.health.findings()) notices.push_back("Health: " + finding.text + ".");
  if (const std::string text = summary.no_road_text(); !text.empty()) notices.push_back(text + ".");
  const std::int64_t without = summary.rejected + summary.failed;
  if (without == 0) return notices;
  std::string text =
      fmt::format("{} of {} frames have no result (frames.csv has the reasons)", without, summary.frames);
  for (std::size_t i = 0; i < summary.reasons.size(); ++i) text += (i == 0 ? ": " : "; ") + summary.reasons[i];
  if (summary.further_reasons() > 0) text += fmt::format("; and {} more", summary.further_reasons());
  notices.push_back(text);
  return notices;
}

std::string caption_of(const io::FlightFrame& frame) {
  const std::size_t damages = frame.damages.size();
  if (damages == 0) return frame.name;
  return fmt::format("{} · {} damage{}", frame.name, damages, damages == 1 ? "" : "s");
}

std::vector<io::ReportedDamage> reported(const std::vector<io::RoadDamage>& damages, const FlightFolder& folder) {
  constexpr std::size_t max_sections = 30;
  std::vector<io::ReportedDamage> worst;
  for (io::RoadDamage& damage : io::worst_first(damages, false)) {
    std::vector<std::uint8_t> section;
    if (worst.size() < max_sections) section = folder.read(damage_section_name(damage.id));
    worst.push_back({std::move(damage), {section.begin(), section.end()}});
  }
  return worst;
}

std::vector<std::array<double, 2>> positions_deg(const std::vector<io::GeoFrame>& frames) {
  std::vector<std::array<double, 2>> points;
  if (std::none_of(frames.begin(), frames.end(),
                   [](const io::GeoFrame& frame) { return frame.position.has_value(); })) {
    return points;
  }
  for (const io::GeoFrame& frame : frames) {
    const io::GeoPosition position = frame.position.value_or(io::GeoPosition{std::nan(""), std::nan("")});
    points.push_back({position.lon_deg, position.lat_deg});
  }
  return points;
}

/// Date of the recording if its times are those of a calendar, then that of the report.
std::vector<std::pair<std::string, std::string>> head_of(const FlightSettings& settings, const FlightSummary& summary) {
  std::vector<std::pair<std::string, std::string>> head = head_lines(settings.head);
  if (const auto time = io::utc_time(summary.first_time_s + settings.track.offset_s)) {
    head.insert(head.end() - 1, {"Recorded", fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", time->year, time->month,
                                                         time->day, time->hour, time->minute)});
  }
  return head;
}

std::string source_name(const FlightSettings& settings) {
  const std::string& name = settings.source.front();
  const std::filesystem::path path = std::filesystem::absolute(name).lexically_normal();
  if (name.find(" ! ") != std::string::npos) return "GStreamer pipeline";
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

}  // namespace

FlightResults::FlightResults(const TrackSettings& track, double min_confidence)
    : inventory_(min_confidence), frames_csv_(io::frames_csv_names()), sightings_csv_(io::sightings_csv_names()) {
  if (!track.file.empty()) positions_.emplace(track);
}

std::vector<std::int64_t> FlightResults::add(const io::FlightFrame& frame) {
  const std::int64_t sequence = summary_.frames;
  const std::optional<std::string> thumbnail = thumbnail_name(sequence);
  if (thumbnail && frame.status == io::FrameStatus::good) {
    thumbnails_.push_back({sequence, *thumbnail, caption_of(frame)});
  }
  summary_.add(frame);
  frames_csv_ += io::frames_csv_row(frame);
  poses_.add(frame);
  if (frame.pose) motion_pieces_ = std::max(motion_pieces_, frame.pose->piece + 1);
  if (frame.rig_bias) rig_bias_.add(*frame.rig_bias);
  std::vector<std::int64_t> road_damages = inventory_.add(frame);
  sightings_csv_ += io::sightings_csv_rows(frame, road_damages);
  if (positions_) positions_->add(frame, road_damages);
  return road_damages;
}

std::vector<io::CaptionedPicture> FlightResults::read_thumbnails(const FlightFolder& folder) const {
  std::vector<io::CaptionedPicture> pictures;
  for (const Thumbnail& thumbnail : thumbnails_) {
    if (!is_shown(thumbnail.sequence, summary_.frames)) continue;
    std::vector<std::uint8_t> jpeg = folder.read(thumbnail.name);
    if (!jpeg.empty()) pictures.push_back({thumbnail.caption, std::move(jpeg)});
  }
  return pictures;
}

std::vector<io::RoadDamage> FlightResults::located_damages() const {
  std::vector<io::RoadDamage> damages = inventory_.damages();
  for (io::RoadDamage& damage : damages) {
    if (!damage.candidate) damage.picture = damage_picture_name(damage.id);
    if (positions_) positions_->locate(damage);
  }
  return damages;
}

std::string FlightResults::report(const FlightSettings& settings, const FlightRun& run, const FlightFolder& folder,
                                  const std::vector<io::RoadDamage>& damages) const {
  io::FlightReportInput report;
  report.title = title_of(settings.head, source_name(settings));
  report.head = head_of(settings, summary_);
  report.properties = properties_of(run, summary_);
  report.notices = notices_of(run, summary_);
  report.curves = summary_.curves;
  report.inspected = summary_.inspected;
  report.untrusted = summary_.untrusted;
  report.flawed = !summary_.health.findings().empty() || !run_notices(run, summary_).empty();
  report.limits = summary_.limits(run.calibration, run.options.damage);
  report.thumbnails = read_thumbnails(folder);
  report.map = run.map;
  report.damages = reported(damages, folder);
  report.candidates = io::worst_first(damages, true);
  report.severity = run.options.damage.severity;
  report.metric = !run.calibration_format.empty();
  if (positions_) {
    report.track_deg = positions_deg(positions_->frames());
    report.segments = io::road_segments(positions_->frames(), damages);
  }
  return io::flight_report(report);
}

std::string FlightResults::write(const FlightSettings& settings, const FlightRun& run, FlightFolder& folder) {
  if (positions_) positions_->place(run.places);
  const std::vector<io::RoadDamage> damages = located_damages();
  const std::vector<io::RoadDamage> worst = io::worst_first(damages, false);
  const std::vector<io::RoadDamage> candidates = io::worst_first(damages, true);
  summary_.settle_times();
  summary_.damages = static_cast<std::int64_t>(worst.size());
  summary_.candidates = static_cast<std::int64_t>(candidates.size());
  for (const io::RoadDamage& damage : worst) summary_.sightings += damage.sightings;
  if (positions_) {
    summary_.located = static_cast<std::int64_t>(positions_->located());
    summary_.located_by_trajectory = static_cast<std::int64_t>(run.places.size());
    summary_.no_position_reason = positions_->no_position_reason();
    if (summary_.no_position_reason.empty()) summary_.track_gaps = positions_->gaps_text();
    summary_.track_outliers = positions_->outliers_text();
  }
  summary_.rig_bias = rig_bias_.estimate(run.calibration);
  std::string json = flight_json(settings, run, summary_, worst);
  std::vector<StagedFile> files;
  if (positions_) {
    files = positions_->files(damages, settings.candidates);
    const std::vector<io::RoadSegment> segments = io::road_segments(positions_->frames(), damages);
    files.push_back(text_file("segments.csv", io::segments_csv(segments, damages)));
  }
  files.push_back(text_file("frames.csv", frames_csv_));
  files.push_back(text_file("pose.csv", poses_.csv()));
  files.push_back(text_file("damages.csv", io::road_damages_csv_names() + io::road_damages_csv_rows(worst)));
  files.push_back(text_file("candidates.csv", io::road_damages_csv_names() + io::road_damages_csv_rows(candidates)));
  files.push_back(text_file("sightings.csv", sightings_csv_));
  files.push_back(text_file("report.html", report(settings, run, folder, damages)));
  if (summary_.rig_bias.order > 0) files.push_back(text_file("rig_bias.json", io::rig_bias_json(summary_.rig_bias)));
  files.push_back(text_file("summary.json", json));
  folder.write(files);
  return json;
}

}  // namespace roadstereo::cli

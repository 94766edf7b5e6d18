#include "flight/flight_results.hpp"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>

#include "finite_values.hpp"
#include "flight/flight_json.hpp"
#include "roadstereo/io/flight_tables.hpp"

namespace roadstereo::cli {

namespace {

std::string range_text(const std::vector<double>& values, const char* unit, int decimals) {
  std::vector<double> known;
  for (const double value : values) {
    if (std::isfinite(value)) known.push_back(value);
  }
  if (known.empty()) return "unknown";
  const double least = quantile(known, 0);
  const double largest = quantile(known, 1);
  return fmt::format("{:.{}f} {} (median; {:.{}f} … {:.{}f})", median(known), decimals, unit, least, decimals, largest,
                     decimals);
}

std::string frames_text(const FlightSummary& summary) {
  std::string text = fmt::format("{}", summary.frames);
  if (summary.refused > 0) text += fmt::format(", {} of them refused", summary.refused);
  if (summary.failed > 0) text += fmt::format(", {} of them failed", summary.failed);
  return text;
}

std::vector<std::pair<std::string, std::string>> facts_of(const FlightRun& run, const FlightSummary& summary,
                                                          const io::FlightInventory& inventory) {
  std::vector<std::pair<std::string, std::string>> facts{{"Source", run.source}, {"Frames", frames_text(summary)}};
  facts.emplace_back("Damages", fmt::format("{} in {} sightings", inventory.damages().size(), summary.sightings));
  facts.emplace_back("Roll", range_text(summary.curves.roll_deg, "°", 2));
  if (!run.calibration_format.empty()) {
    facts.emplace_back("Height over the road", range_text(summary.curves.height_m, "m", 3));
  }
  facts.emplace_back("Spread around the road", range_text(summary.curves.sigma_d_px, "px", 3));
  facts.emplace_back("Road estimated anew", fmt::format("in {} of {} frames", summary.road_estimated, summary.good));
  facts.emplace_back("Time of a frame", fmt::format("{} matching, {} damage", range_text(summary.matching_ms, "ms", 1),
                                                    range_text(summary.damage_ms, "ms", 1)));
  if (summary.placed) facts.emplace_back("On the map", fmt::format("{} of {} frames", *summary.placed, summary.frames));
  facts.emplace_back("Engine", fmt::format("{}, {} threads", run.engine, run.threads));
  return facts;
}

std::vector<std::string> notices_of(const FlightRun& run, const FlightSummary& summary) {
  std::vector<std::string> notices;
  if (!run.complete) notices.emplace_back("The flight was stopped before its end; inspect --resume goes on with it.");
  if (!summary.track_note.empty()) notices.push_back("No frame has a place on the map: " + summary.track_note + ".");
  const std::int64_t without = summary.refused + summary.failed;
  if (without == 0) return notices;
  std::string text =
      fmt::format("{} of {} frames have no result (frames.csv has the reasons)", without, summary.frames);
  for (std::size_t i = 0; i < summary.reasons.size(); ++i) text += (i == 0 ? ": " : "; ") + summary.reasons[i];
  notices.push_back(text);
  return notices;
}

/// The evenly spaced small pictures, with the frames' names.
std::vector<io::CaptionedPicture> strip_of(const io::FlightJournal& journal, const FlightFolder& folder) {
  std::vector<io::CaptionedPicture> strip;
  std::int64_t place = 0;
  journal.for_each([&](const io::FlightFrame& frame) {
    const std::int64_t here = place++;
    const auto name = thumbnail_name(here);
    if (!name || !is_shown(here, journal.frames()) || frame.status != io::FrameStatus::good) return;
    std::string caption = frame.name;
    if (!frame.damages.empty())
      caption += fmt::format(" · {} damage{}", frame.damages.size(), frame.damages.size() == 1 ? "" : "s");
    std::vector<std::uint8_t> jpeg = folder.read(*name);
    if (!jpeg.empty()) strip.push_back({caption, std::move(jpeg)});
  });
  return strip;
}

std::vector<io::PicturedDamage> worst_of(const io::FlightInventory& inventory, const FlightFolder& folder) {
  constexpr std::size_t most = 100;
  std::vector<io::PicturedDamage> worst;
  for (io::RoadDamage& damage : inventory.worst(most)) {
    std::vector<std::uint8_t> jpeg = folder.read(damage_picture_name(damage.id));
    worst.push_back({std::move(damage), std::move(jpeg)});
  }
  return worst;
}

std::string title_of(const FlightSettings& settings) {
  const std::string& name = settings.source.front();
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  if (name.find(" ! ") != std::string::npos) return "GStreamer pipeline";
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

std::string report_of(const FlightSettings& settings, const FlightRun& run, const FlightSummary& summary,
                      const io::FlightJournal& journal, const io::FlightInventory& inventory,
                      const FlightFolder& folder) {
  io::FlightReportInput report;
  report.title = title_of(settings);
  report.facts = facts_of(run, summary, inventory);
  report.notices = notices_of(run, summary);
  report.curves = summary.curves;
  report.strip = strip_of(journal, folder);
  report.worst = worst_of(inventory, folder);
  report.damages = inventory.damages().size();
  report.metric = !run.calibration_format.empty();
  return io::flight_report(report);
}

}  // namespace

std::string write_flight_results(const FlightSettings& settings, const FlightRun& run, const io::FlightJournal& journal,
                                 std::optional<FlightPlaces>& places, FlightFolder& folder, FlightSummary& summary) {
  std::string frames = io::frames_csv_names();
  std::string damages = io::flight_damages_csv_names();
  io::FlightInventory inventory;
  journal.for_each([&](const io::FlightFrame& frame) {
    summary.add(frame);
    frames += io::frames_csv_row(frame);
    damages += io::flight_damages_csv_rows(frame, inventory.add(frame));
    if (places) places->add(frame);
  });
  summary.settle_times();
  summary.damages = static_cast<std::int64_t>(inventory.damages().size());
  if (places) {
    summary.placed = static_cast<std::int64_t>(places->placed());
    summary.track_note = places->why_nowhere();
  }
  std::string json = flight_json(settings, run, summary, inventory);
  std::vector<StagedFile> files = places ? places->files() : std::vector<StagedFile>{};
  files.push_back(text_file("frames.csv", frames));
  files.push_back(text_file("damages.csv", damages));
  files.push_back(text_file("report.html", report_of(settings, run, summary, journal, inventory, folder)));
  files.push_back(text_file("summary.json", json));
  folder.write(files);
  return json;
}

}  // namespace roadstereo::cli

#include "inspect_flight.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "flight/flight_results.hpp"
#include "flight/provenance.hpp"
#include "flight/run_flight.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

namespace {

std::optional<std::int64_t> frames_to_do(const FlightSettings& settings, const io::FrameSource& source) {
  const std::optional<std::int64_t> size = source.size();
  if (!size) return std::nullopt;
  const std::int64_t last = settings.to ? std::min(*settings.to, *size - 1) : *size - 1;
  return last < settings.from ? 0 : (last - settings.from) / settings.every + 1;
}

io::FlightJournal open_journal(const FlightSettings& settings, const PipelineOptions& options, FlightFolder& folder) {
  const io::Provenance made_with = provenance(settings, options);
  if (settings.resume && std::filesystem::exists(folder.journal())) {
    return io::FlightJournal::resume(folder.journal(), made_with);
  }
  folder.remove_earlier_flight();
  return io::FlightJournal::begin(folder.journal(), made_with);
}

std::string flight_text(const FlightRun& run, const FlightSummary& summary, const FlightFolder& folder) {
  std::string text = fmt::format("roadstereo {}: {}\n", version, run.source);
  text += fmt::format("  frames    {} ({} rejected, {} failed), road re-estimated in {}\n", summary.frames,
                      summary.rejected, summary.failed, summary.road_estimated);
  text += fmt::format("  damage    {} damages in {} sightings, {} candidates\n", summary.damages, summary.sightings,
                      summary.candidates);
  if (summary.located)
    text += fmt::format("  track     {} of {} frames have a position\n", *summary.located, summary.frames);
  if (!summary.no_position_reason.empty()) text += fmt::format("            {}\n", summary.no_position_reason);
  text += fmt::format("  time      {:.1f} s, {:.1f} frames/s\n", run.seconds, run.frames_per_second);
  for (const std::string& reason : summary.reasons) text += fmt::format("  no result {}\n", reason);
  return text + fmt::format("  report    {}\n", (folder.path() / "report.html").string());
}

/// Clouds and trajectories are metric. The calibration may be that of a bag.
void require_calibration(const FlightPlan& plan, bool trajectory, const RectifiedSource& source) {
  const bool cloud = std::find(plan.write.begin(), plan.write.end(), FrameFile::cloud) != plan.write.end();
  if (cloud && source.calibration_format().empty()) {
    fail("--write cloud needs --calibration");
  }
  if (trajectory && source.calibration_format().empty()) fail("--trajectory needs --calibration");
}

/// Called before an earlier flight is removed.
void require_frames(const FlightSettings& settings, const io::FrameSource& source) {
  if (frames_to_do(settings, source) != 0) return;
  fail(settings.source[0], ": the source has ", source.size().value_or(0), " frames; --from is ", settings.from);
}

}  // namespace

void inspect_flight(FlightSettings settings) {
  const FlightPlan plan = resolve(settings);
  FlightRun run;
  run.options = plan.options;
  FlightResults results(settings.track);
  std::unique_ptr<io::FrameSource> frames = io::open_source(settings.source, plan.source);
  if (settings.calibration.empty() && !frames->calibration_file().empty()) {
    settings.calibration = {frames->calibration_file()};
  }
  RectifiedSource source(std::move(frames), settings.calibration);
  if (source.source().live()) fail(settings.source[0], ": cameras are not supported by inspect; use roadstereo live");
  require_calibration(plan, settings.trajectory, source);
  require_frames(settings, source.source());
  FlightFolder folder(settings.output);
  for (const auto& inputs : {settings.source, settings.calibration, std::vector{settings.track.file}}) {
    for (const std::string& input : inputs) folder.protect(input);
  }
  io::FlightJournal journal = open_journal(settings, run.options, folder);
  journal.for_each([&](const io::FlightFrame& frame) { results.add(frame); });
  if (journal.last() && journal.last()->white_level > 0) source.set_white_level(journal.last()->white_level);
  run.resumed_at = journal.frames();

  Progress progress(frames_to_do(settings, source.source()), journal.frames(), settings.quiet);
  auto stop = std::make_unique<StopSignals>();  // until here Ctrl-C ends the program
  std::optional<FlightTrajectory> trajectory;
  Flight flight{source, folder, journal, results, trajectory, plan, progress, *stop};
  run.complete = run_flight(settings, flight);
  stop.reset();  // the next Ctrl-C ends the program
  if (journal.last() && journal.last()->white_level > 0) run.options.white_level = journal.last()->white_level;
  run.seconds = progress.seconds();
  run.frames_per_second = progress.frames_per_second();
  run.source = source.source().description();
  run.calibration_format = source.calibration_format();
  run.engine = resolve_engine_name(run.options.engine);
  run.threads = used_threads(run.options);

  if (trajectory) folder.write(trajectory->files());
  const std::string json = results.write(settings, run, folder);
  const FlightSummary& summary = results.summary();
  progress.end();
  if (settings.json) fmt::print("{}", json);
  if (!settings.json && !settings.quiet) {
    fmt::print("{}", flight_text(run, summary, folder));
    if (trajectory) fmt::print("  path      {}\n", trajectory->summary());
  }
  if (!run.complete) throw Interrupted{"interrupted; continue with --resume"};
  if (summary.frames == 0) fail(settings.source[0], ": there is no frame between --from and --to");
  if (summary.good == 0) fail("none of the ", summary.frames, " frames could be matched: ", summary.reasons.front());
}

}  // namespace roadstereo::cli

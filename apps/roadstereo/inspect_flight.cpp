#include "inspect_flight.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "auto_mask.hpp"
#include "core/parallel.hpp"
#include "flight/flight_record.hpp"
#include "flight/flight_results.hpp"
#include "flight/run_flight.hpp"
#include "map/make_map.hpp"
#include "map/map_files.hpp"
#include "mask_file.hpp"
#include "output_owner.hpp"
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

std::string flight_text(const FlightRun& run, const FlightSummary& summary, const FlightFolder& folder) {
  std::string text = fmt::format("roadstereo {}: {}\n", version, run.source);
  text += fmt::format("  frames    {} ({} rejected, {} failed), road re-estimated in {}\n", summary.frames,
                      summary.rejected, summary.failed, summary.road_estimated);
  if (summary.static_mask.share > 0) text += "  mask      " + static_mask_text(summary.static_mask) + "\n";
  const auto counted = [](std::int64_t count, const char* name) {
    return fmt::format("{} {}{}", count, name, count == 1 ? "" : "s");
  };
  text += fmt::format("  damage    {} in {}, {}\n", counted(summary.damages, "damage"),
                      counted(summary.sightings, "sighting"), counted(summary.candidates, "candidate"));
  const io::InspectionLimits limits = summary.limits(run.calibration, run.options.damage);
  if (summary.damages == 0 && !limits.doubts.empty()) {
    text += fmt::format("            but the road was not inspected reliably: {}\n", limits.doubts.front());
  } else if (summary.damages == 0 && !limits.limit.empty()) {
    text += fmt::format("            the limit is {}\n", limits.limit);
  }
  if (const std::string none = summary.no_road_text(); !none.empty()) text += "            " + none + "\n";
  for (const std::string& notice : run_notices(run, summary)) text += fmt::format("  notice    {}\n", notice);
  for (const HealthFinding& finding : summary.health.findings()) {
    text += fmt::format("  health    {}: {}\n", finding.id, finding.text);
  }
  if (summary.located)
    text += fmt::format("  track     {} of {} frames have a position{}\n", *summary.located, summary.frames,
                        summary.located_by_trajectory > 0 ? ", by the trajectory" : "");
  if (!summary.track_gaps.empty()) text += fmt::format("            {}\n", summary.track_gaps);
  if (!summary.track_outliers.empty()) text += fmt::format("            {}\n", summary.track_outliers);
  if (!summary.no_position_reason.empty()) text += fmt::format("            {}\n", summary.no_position_reason);
  if (summary.rig_bias.order > 0) {
    text += fmt::format("  rig bias  {:.3f} ± {:.3f} px over the road, or its shape: rig_bias.json\n",
                        summary.rig_bias.rms_px, summary.rig_bias.rms_std_error_px);
  }
  text += fmt::format("  time      {:.1f} s, {:.1f} frames/s\n", run.seconds, run.frames_per_second);
  for (const std::string& reason : summary.reasons) text += fmt::format("  no result {}\n", reason);
  if (summary.further_reasons() > 0) {
    text += fmt::format("            and {} more: see frames.csv\n", summary.further_reasons());
  }
  return text + fmt::format("  report    {}\n", (folder.path() / "report.html").string());
}

/// Clouds and trajectories are metric. The calibration may be that of a bag.
void require_calibration(const FlightPlan& plan, const FlightSettings& settings, const RectifiedSource& source) {
  const bool cloud = std::find(plan.write.begin(), plan.write.end(), FrameFile::cloud) != plan.write.end();
  if (cloud && source.calibration_format().empty()) {
    fail("--write cloud needs --calibration");
  }
  if (settings.trajectory && source.calibration_format().empty()) {
    fail(settings.map ? "--map" : "--trajectory", " needs --calibration");
  }
}

/// Called before an earlier flight is removed.
void require_frames(const FlightSettings& settings, const io::FrameSource& source) {
  if (frames_to_do(settings, source) != 0) return;
  fail(settings.source[0], ": the source has ", source.size().value_or(0), " frames; --from is ", settings.from);
}

/// Maps the flight along its trajectory: its poses are final only now, so the frames are matched again. Returns the
/// text for the terminal.
std::string add_map(const FlightSettings& settings, const FlightPlan& plan, const FlightFolder& folder,
                    const io::StaticMaskRecord& static_mask, const std::string& crs, const StopSignals& stop,
                    FlightRun& run) {
  MapPlan map;
  MapPass& pass = map.passes.emplace_back();
  pass.source = settings.source;
  pass.source_settings = settings.source_settings;
  pass.calibration = settings.calibration;
  pass.trajectory = (folder.path() / trajectory_file_names().front()).string();
  pass.from = settings.from;
  pass.to = settings.to;
  pass.every = settings.every;
  pass.options = plan.options;
  pass.find_white_level = plan.find_white_level;
  constexpr int white = 255;
  pass.mask = static_mask.applied ? read_mask((folder.path() / static_mask_file).string(), white) : plan.mask;
  pass.time_offset_s = settings.track.offset_s;
  map.output = folder.path() / "map";
  map.crs = crs;
  map.resume = settings.resume;
  map.quiet = settings.quiet;
  try {
    MapSummary made = make_map(map, stop);
    run.map = {std::move(made.picture), std::move(made.damages)};
    return made.text;
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    run.no_map_reason = error.what();
  } catch (const Interrupted&) {
    run.complete = false;
  }
  return {};
}

/// Closes the loops of a trajectory. What forbids it does not cost the inspection: returns the reason, else nothing.
std::string optimise(FlightTrajectory& trajectory, const TrackSettings& track) {
  try {
    trajectory.optimise(track);
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

void inspect_flight(FlightSettings settings) {
  settings.trajectory = settings.trajectory || settings.map;
  const FlightPlan plan = resolve(settings);
  FlightRun run;
  run.options = plan.options;
  FlightResults results(settings.track, run.options.damage.min_confidence);
  std::unique_ptr<io::FrameSource> frames = io::open_source(settings.source, plan.source);
  if (settings.calibration.empty() && !frames->calibration_file().empty()) {
    settings.calibration = {frames->calibration_file()};
  }
  RectifiedSource source(std::move(frames), settings.calibration, plan.options.threads);
  if (source.source().live()) fail(settings.source[0], ": cameras are not supported by inspect; use roadstereo live");
  if (!plan.find_white_level) source.ignore_white_level();
  require_calibration(plan, settings, source);
  require_frames(settings, source.source());
  require_no_other_owner(settings.output, OutputOwner::recording);
  FlightFolder folder(settings.output);
  for (const std::string& input : input_files(settings)) folder.protect(input);
  FlightRecord record(settings, plan, !source.calibration_format().empty(), folder);
  record.for_each([&](const io::FlightFrame& frame) { results.add(frame); });
  run.resumed_at = record.frames();
  if (const auto done = record.last(); settings.to && done && done->index > *settings.to) {
    fail(settings.output, ": frames up to ", done->index, " are finished; --to is ", *settings.to);
  }
  record.resume_mcap(results.summary().good);
  Progress progress(frames_to_do(settings, source.source()), record.frames(), settings.quiet);
  auto stop = std::make_unique<StopSignals>();  // until here Ctrl-C ends the program
  std::optional<FlightTrajectory> trajectory;
  Flight flight{source, folder, record, results, trajectory, plan, progress, *stop};
  run.complete = run_flight(settings, flight);
  run.seconds = progress.seconds();
  run.frames_per_second = progress.frames_per_second();
  progress.end();
  std::string graph_error;
  if (trajectory) {
    if (run.complete) graph_error = optimise(*trajectory, settings.track);
    folder.write(trajectory->files());
    for (const HealthFinding& finding : trajectory->findings()) results.add(finding);
  }
  std::string map_text;
  if (settings.map && trajectory && run.complete)
    map_text = add_map(settings, plan, folder, results.summary().static_mask, trajectory->crs(), *stop, run);
  stop.reset();  // the next Ctrl-C ends the program
  if (const auto last = record.last(); last && last->white_level > 0) run.options.white_level = last->white_level;
  if (trajectory) {
    run.crs = trajectory->crs();
    run.places = trajectory->places();
    run.path = trajectory->summary();
    run.track = trajectory->track_fit();
    run.track_unused = trajectory->track_unused();
  }
  if (!settings.calibration.empty()) run.calibration_file = settings.calibration.front();
  run.size_doubt = source.size_doubt();
  run.expected_height_m = settings.height_m;
  run.expected_pitch_deg = settings.pitch_deg;
  run.source = source.source().description();
  run.calibration_format = source.calibration_format();
  run.calibration = source.sized_calibration();
  run.engine = resolve_engine_name(run.options.engine);
  run.threads = resolve_threads(run.options.threads);

  record.finish();
  const std::string json = results.write(settings, run, folder);
  if (run.resumed_at > 0) {
    folder.remove_unwritten();
    if (!run.map) remove_map(folder.path() / "map");
  }
  const FlightSummary& summary = results.summary();
  if (settings.json) fmt::print("{}", json);
  if (!settings.json && !settings.quiet) {
    fmt::print("{}", flight_text(run, summary, folder));
    if (trajectory) fmt::print("  path      {}\n", run.path);
    fmt::print("{}", map_text);
  }
  if (!run.complete) throw Interrupted{"interrupted; continue with --resume"};
  if (summary.frames == 0) fail(settings.source[0], ": there is no frame between --from and --to");
  if (summary.good == 0) fail("none of the ", summary.frames, " frames could be matched: ", summary.reasons.front());
  const std::string contradiction = trajectory ? trajectory->track_contradiction() : std::string();
  if (!graph_error.empty()) fail("the trajectory is that of the odometry alone: ", graph_error);
  if (!contradiction.empty()) fail(settings.track.file, ": ", contradiction);
  if (!run.no_map_reason.empty()) fail("there is no map: ", run.no_map_reason);
}

}  // namespace roadstereo::cli

#include "map/map_settings.hpp"

#include <algorithm>

#include "map/run_folder.hpp"
#include "output_owner.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

namespace {

/// Options of recordings that runs have of their own.
void reject_run_options(const MapSettings& settings) {
  const auto reject = [&](const char* option) {
    fail(settings.source.front(),
         " contains an output of inspect (summary.json), which is mapped with the settings of its "
         "run; ",
         option, " is for recordings: write outputs to a folder of their own");
  };
  if (!settings.calibration.empty()) reject("--calibration");
  if (!settings.processing.settings.empty()) reject("--set");
  const ProcessingSettings usual;
  if (settings.processing.preset != usual.preset) reject("--preset");
  if (settings.processing.scope != usual.scope) reject("--scope");
  const SourceSettings& source = settings.source_settings;
  const SourceSettings usual_source;
  if (source.layout != usual_source.layout) reject("--layout");
  if (!source.topics.empty()) reject("--topics");
  if (source.max_time_difference_ms != usual_source.max_time_difference_ms) reject("--max-time-difference");
  if (source.rate_hz != usual_source.rate_hz) reject("--rate");
  if (source.camera_size != usual_source.camera_size) reject("--camera-size");
}

/// The poses of a run are in its own system, whatever --crs says.
void require_own_crs(const std::string& folder, const MapPass& run, const std::string& crs) {
  if (run.crs.empty() || crs.empty() || run.crs == crs) return;
  fail(folder, ": the poses of this run are in ", run.crs, "; --crs is ", crs);
}

/// The system that the poses of all runs are in; empty if they are in none. Throws Error if they differ.
std::string common_crs(const std::vector<std::string>& folders, const std::vector<MapPass>& runs) {
  for (std::size_t k = 1; k < runs.size(); ++k) {
    if (runs[k].crs == runs[0].crs) continue;
    const auto text = [](const std::string& crs) { return crs.empty() ? "that of its first camera" : crs; };
    fail("the poses of the runs are in different systems: ", folders[0], " in ", text(runs[0].crs), ", ", folders[k],
         " in ", text(runs[k].crs), "; give each run a --trajectory FILE, all in one world");
  }
  if (runs.size() > 1 && runs[0].crs.empty()) {
    fail("the worlds of ", runs.size(),
         " runs are those of their first cameras, not one; give each run "
         "a --trajectory FILE, all in one world, or --crs if theirs are in that system");
  }
  return runs[0].crs;
}

std::vector<MapPass> runs_of(const MapSettings& settings) {
  reject_run_options(settings);
  const std::vector<std::string>& trajectory = settings.trajectory;
  if (!trajectory.empty() && trajectory.size() != settings.source.size()) {
    fail("map has ", settings.source.size(), " runs and ", trajectory.size(),
         " trajectories; either each run has another --trajectory FILE than its own or none");
  }
  const PipelineOptions options = make_options(settings.processing);
  std::vector<MapPass> passes;
  for (const std::string& folder : settings.source) {
    passes.push_back(read_run(folder));
    if (trajectory.empty()) {
      require_own_crs(folder, passes.back(), settings.crs);
    } else {
      MapPass& pass = passes.back();
      pass.trajectory = trajectory[passes.size() - 1];
      pass.from = 0;
      pass.to.reset();
      pass.every = 1;
    }
    passes.back().options.threads = settings.processing.threads;
    if (settings.processing.engine != ProcessingSettings().engine) passes.back().options.engine = options.engine;
    if (settings.sets_severity) passes.back().options.damage.severity = options.damage.severity;
    if (options.rig_bias) passes.back().options.rig_bias = options.rig_bias;
  }
  return passes;
}

std::vector<MapPass> recordings_of(const MapSettings& settings) {
  const std::vector<std::string>&source = settings.source, &trajectory = settings.trajectory;
  if (trajectory.empty()) fail("map needs --trajectory FILE: the pose of every frame, 12 numbers a line");
  const bool one_each = trajectory.size() == source.size();
  if (!one_each && !(trajectory.size() == 1 && source.size() == 2)) {
    fail("map has ", source.size(), " recordings and ", trajectory.size(),
         " trajectories; every recording needs one --trajectory FILE");
  }
  MapPass pass;
  make_source_options(settings.source_settings);  // checked first
  pass.source_settings = settings.source_settings;
  pass.calibration = settings.calibration;
  pass.options = make_options(settings.processing);
  pass.find_white_level = !sets_white_level(settings.processing);
  std::vector<MapPass> passes;
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    pass.source = one_each ? std::vector{source[k]} : source;
    pass.trajectory = trajectory[k];
    passes.push_back(pass);
  }
  return passes;
}

}  // namespace

void MapSettings::validate() const {
  if (!(cell_m == 0 || (cell_m >= 0.0005 && cell_m <= 10))) {
    fail("--cell is ", cell_m, "; it must be between 0.0005 and 10 metres");
  }
  if (every < 1) fail("--every is ", every, "; it must be at least 1");
}

MapPlan MapSettings::plan() const {
  validate();
  const MapOptions& options = *this;
  MapPlan plan{options, {}, output};
  const auto runs = static_cast<std::size_t>(std::count_if(
      source.begin(), source.end(), [](const std::string& name) { return owner_of(name) == OutputOwner::recording; }));
  if (runs != 0 && runs != source.size()) {
    fail("map takes either recordings or outputs of inspect, not both: ", runs, " of ", source.size(),
         " contain an output (summary.json)");
  }
  plan.passes = runs > 0 ? runs_of(*this) : recordings_of(*this);
  if (runs > 0 && trajectory.empty() && crs.empty()) plan.crs = common_crs(source, plan.passes);
  if (!day.empty() && day.size() != plan.passes.size()) {
    fail("map has ", plan.passes.size(), " recordings and ", day.size(),
         " days; either each has one --day NAME or none");
  }
  for (std::size_t k = 0; k < day.size(); ++k) plan.passes[k].day = day[k];
  return plan;
}

}  // namespace roadstereo::cli

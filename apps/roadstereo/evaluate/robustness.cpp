#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "core/order_statistics.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/labelled_sheet.hpp"
#include "evaluate/rendered_sources.hpp"
#include "evaluate/report.hpp"
#include "evaluate/robustness_trials.hpp"
#include "evaluate/score_columns.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

struct RobustnessArguments {
  std::vector<std::string> folders;
  int scenes = 10;
  MethodSettings methods;
  std::string json, figure;
};

/// Trials of one source.
struct SourceTrials {
  std::string name;
  std::vector<RobustnessTrial> trials;
  std::size_t worst = 0;
  std::vector<io::SheetCell> worst_row;  ///< of the sheet; empty without --figure
};

SourceTrials run_source(const LabelledSource& source, const MethodSettings& methods, bool draw, Progress& progress) {
  SourceTrials result{source.name, {}, 0, {}};
  for (std::size_t i = 0; i < source.frames.size(); ++i) {
    const LabelledFrame frame = source.read_labelled(i);
    const RobustnessResult run = run_robustness_trial(source.frames[i], frame, methods);
    result.trials.push_back(run.trial);
    progress.frame_done();
    if (i > 0 && !run.trial.worse_than(result.trials[result.worst])) continue;
    result.worst = i;
    if (!draw) continue;
    const auto peer = static_cast<std::size_t>(
        std::find(robustness_methods().begin(), robustness_methods().end(), "HH4") - robustness_methods().begin());
    result.worst_row = labelled_sheet_row(source.name + ", " + run.trial.frame, frame, {{"default", run.maps.front()}},
                                          {"HH4", run.maps[peer]});
  }
  return result;
}

double percent_with(const std::vector<RobustnessTrial>& trials, RoadStatus status) {
  const auto count =
      std::count_if(trials.begin(), trials.end(), [status](const auto& trial) { return trial.status == status; });
  return 100.0 * static_cast<double>(count) / static_cast<double>(trials.size());
}

Table road_table(const std::vector<SourceTrials>& sources) {
  Table table{"Roads",
              {{"source", "source"},
               {"frames", "frame_count"},
               {"found %", "found_percent"},
               {"weak %", "weak_percent"},
               {"plane px", "plane_px"},
               {"worst frame", "worst_frame"}},
              {}};
  for (const SourceTrials& source : sources) {
    std::vector<double> differences;
    for (const RobustnessTrial& trial : source.trials) differences.push_back(trial.plane_px);
    table.rows.push_back({Cell(source.name), Cell(static_cast<double>(source.trials.size()), 0),
                          Cell(100 - percent_with(source.trials, RoadStatus::none), 1),
                          Cell(percent_with(source.trials, RoadStatus::weak), 1), Cell(upper_median(differences), 2),
                          Cell(source.trials[source.worst].frame)});
  }
  return table;
}

void add_scores(const std::string& name, const std::vector<DisparityScore>& scores, Table& table) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    table.rows.push_back(score_cells({name, robustness_methods()[i]}, scores[i]));
  }
}

Table empty_score_table(const std::string& title, const Column& first) {
  return {title, score_columns({first, {"method", "method"}}, robustness_tolerances_px()), {}};
}

Table score_table(const std::vector<SourceTrials>& sources) {
  Table table = empty_score_table("Disparities of the roads, mean over the frames", {"source", "source"});
  for (const SourceTrials& source : sources) {
    std::vector<DisparityScore> means;
    for (std::size_t method = 0; method < robustness_methods().size(); ++method) {
      std::vector<DisparityScore> of_method;
      for (const RobustnessTrial& trial : source.trials) of_method.push_back(trial.scores[method]);
      means.push_back(mean_score(of_method));
    }
    add_scores(source.name, means, table);
  }
  return table;
}

Table drive_table(const std::vector<Drive>& drives, const MethodSettings& methods) {
  Table table{"Drives",
              {{"drive", "drive"},
               {"frames", "frame_count"},
               {"tracked %", "tracked_percent"},
               {"found anew %", "found_percent"},
               {"none %", "none_percent"},
               {"damages", "damages"}},
              {}};
  for (const Drive& drive : drives) {
    const DriveCounts counts = run_drive(drive, methods);
    const auto percent = [&](int count) { return Cell(100.0 * count / std::max(1, counts.frames), 1); };
    table.rows.push_back({Cell(drive.name), Cell(counts.frames, 0), percent(counts.tracked), percent(counts.found),
                          percent(counts.none), Cell(counts.damages, 0)});
  }
  return table;
}

/// Adds every frame with its status, plane and scores: sources of one name share their list.
void add_frames(const SourceTrials& source, nlohmann::ordered_json& frames) {
  for (const RobustnessTrial& trial : source.trials) {
    Table scores = empty_score_table("", {"frame", "frame"});
    add_scores(trial.frame, trial.scores, scores);
    frames.push_back({{"frame", trial.frame},
                      {"status", name_of(trial.status)},
                      {"plane_px", Cell(trial.plane_px, 2).json()},
                      {"scores", scores.json()}});
  }
}

void robustness(const RobustnessArguments& arguments) {
  if (arguments.scenes < 0 || arguments.scenes > 10000) {
    fail("--scenes is ", arguments.scenes, "; it must be between 0 and 10000");
  }
  RobustnessSources found = find_robustness_sources(arguments.folders);
  if (arguments.scenes > 0) {
    found.labelled.push_back(rendered_roads(arguments.scenes, arguments.methods.threads));
    found.labelled.push_back(rendered_streets(arguments.scenes, arguments.methods.threads));
    found.labelled.push_back(rendered_wide_scenes(arguments.scenes, arguments.methods.threads));
  }
  if (found.labelled.empty() && found.drives.empty()) fail("there is no source: give DIR, or --scenes above 0");
  std::vector<SourceTrials> sources;
  std::size_t frames = 0;
  for (const LabelledSource& source : found.labelled) frames += source.frames.size();
  Progress progress = Progress::on_terminal(frames);
  for (const LabelledSource& source : found.labelled) {
    sources.push_back(run_source(source, arguments.methods, !arguments.figure.empty(), progress));
  }
  progress.end();
  const Table roads = road_table(sources), scores = score_table(sources),
              drives = drive_table(found.drives, arguments.methods);
  if (!sources.empty()) fmt::print("{}\n{}\n{}", roads.text(), scores.text(), score_legend());
  if (!found.drives.empty()) fmt::print("{}\n", drives.text());
  if (!arguments.json.empty()) {
    nlohmann::ordered_json document{{"roads", roads.json()}, {"disparities", scores.json()}, {"drives", drives.json()}};
    for (const SourceTrials& source : sources) add_frames(source, document["frames"][source.name]);
    write_report(arguments.json, document);
  }
  if (arguments.figure.empty()) return;
  std::vector<std::vector<io::SheetCell>> sheet;
  sheet.reserve(sources.size());
  for (SourceTrials& source : sources) sheet.push_back(std::move(source.worst_row));
  constexpr int cell_width = 620;
  write_figure(arguments.figure, io::picture_sheet(sheet, cell_width));
}

constexpr const char* robustness_footer =
    R"(DIR and its subfolders are searched for sources, recognised by content: the layout of KITTI Stereo 2015 with masks in
road/; folders of one scene each (left.png, right.png, disparity.tiff, occ.png, region.png, calibration.yaml); recordings
with a calibration.yaml. Scores are those of the pixels of the road. plane: largest difference over the road of the plane
before matching to the robust fit to the truth, median of the frames; ∞ where most frames have no road. The worst frame
has no road, or the most errors above 1 px.

Example:
  roadstereo evaluate robustness kitti2015 wider --scenes 20 --figure worst.png --json robustness.json)";

}  // namespace

void add_robustness(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand(
      "robustness", "Share of roads found, and disparities of roads, on every kind of source at once");
  command->footer(robustness_footer);
  const auto arguments = std::make_shared<RobustnessArguments>();
  command->add_option("DIR", arguments->folders, "Folders of sources");
  command->add_option("--scenes", arguments->scenes, "Number of rendered random roads, of streets and of wide scenes")
      ->type_name("N")
      ->capture_default_str();
  add_method_options(*command, arguments->methods);
  add_json_option(*command, arguments->json);
  add_figure_option(*command, arguments->figure);
  command->callback([arguments] { robustness(*arguments); });
}

}  // namespace roadstereo::cli

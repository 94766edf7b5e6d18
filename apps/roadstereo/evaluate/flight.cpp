#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "benchmark_report.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/flight_trials.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "finite_values.hpp"
#include "flight_path.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

struct FlightArguments {
  FlightOptions flight;
  std::string json;
};

constexpr const char* flight_note =
    R"(plane: maximum difference from the true plane over the image; the true plane has no camber. ∞: no road was found. independent: a pipeline
that is reset before every frame. Times are those of the tracking pipeline, from frames in memory to the result. Each
pass is a separate pipeline that has processed the same frames. CPU time is summed over all threads. Memory is allocated
and threads are started before the first frame, except with --cold.
)";

using FlightTrials = std::vector<FlightTrial>;
using Stage = RoadError StageErrors::*;
using Quantity = double RoadError::*;

std::vector<double> errors(const FlightTrials& frames, StageErrors FlightTrial::*start, Stage stage,
                           Quantity quantity) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FlightTrial& frame : frames) {
    const double value = (frame.*start).*stage.*quantity;
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

double maximum(const std::vector<double>& values) {
  return values.empty() ? NAN : *std::max_element(values.begin(), values.end());
}

/// Maximum excess of the error of a tracked frame over that of the same frame processed independently; infinite if only
/// tracking lost a road.
double max_excess(const FlightTrials& frames, Stage stage, Quantity quantity) {
  std::vector<double> excess;
  excess.reserve(frames.size());
  for (const FlightTrial& frame : frames) {
    const double difference = frame.tracked.*stage.*quantity - frame.fresh.*stage.*quantity;
    if (!std::isnan(difference)) excess.push_back(difference);
  }
  return maximum(excess);
}

Table error_table(const FlightTrials& frames, const FlightOptions& options) {
  Table table{fmt::format("{} frames of scene {}, {}, flight {}, preset {}", frames.size(), options.scene, options.size,
                          options.flight, options.preset),
              {{"estimate", "estimate"},
               {"start", "start"},
               {"psi 95 % rad", "roll_p95_rad"},
               {"max", "roll_max_rad"},
               {"max excess", "roll_max_excess_rad"},
               {"plane 95 % px", "plane_p95_px"},
               {"max", "plane_max_px"},
               {"max excess", "plane_max_excess_px"}},
              {}};
  const auto add = [&](const char* name, const char* start_name, StageErrors FlightTrial::*start, Stage stage) {
    const bool is_tracked = start == &FlightTrial::tracked;
    std::vector<Cell> row{name, start_name};
    for (const auto& [quantity, decimals] : {std::pair(&RoadError::roll_rad, 5), std::pair(&RoadError::plane_px, 3)}) {
      const std::vector<double> values = errors(frames, start, stage, quantity);
      row.emplace_back(quantile(values, 0.95), decimals);
      row.emplace_back(maximum(values), decimals);
      row.emplace_back(is_tracked ? max_excess(frames, stage, quantity) : NAN, decimals);
    }
    table.rows.push_back(row);
  };
  add("before matching", "tracked", &FlightTrial::tracked, &StageErrors::before);
  add("before matching", "independent", &FlightTrial::fresh, &StageErrors::before);
  add("after matching", "tracked", &FlightTrial::tracked, &StageErrors::after);
  add("after matching", "independent", &FlightTrial::fresh, &StageErrors::after);
  return table;
}

Table time_table(const FlightTrials& frames, const FlightOptions& options) {
  Table table{fmt::format("Times, {} threads requested (0: all), {}", options.methods.threads, cpu_name()),
              {{"time", "time"},
               {"median ms", "median_ms"},
               {"max ms", "max_ms"},
               {"in frame", "frame_of_max"},
               {"max / median", "max_over_median"},
               {"first frame ms", "first_frame_ms"},
               {"first / median", "first_over_median"}},
              {}};
  const auto add = [&](const std::string& name, const auto& time) {
    std::vector<double> times;
    times.reserve(frames.size());
    for (const FlightTrial& frame : frames) times.push_back(time(frame));
    const auto slowest = std::max_element(times.begin(), times.end());
    const double middle = median(times);
    table.rows.push_back({name, Cell(middle, 2), Cell(*slowest, 2),
                          Cell(static_cast<double>(slowest - times.begin()), 0), Cell(*slowest / middle, 2),
                          Cell(times.front(), 2), Cell(times.front() / middle, 2)});
  };
  const auto minimum = [](const std::vector<double>& ms) { return *std::min_element(ms.begin(), ms.end()); };
  add("first pass", [](const FlightTrial& frame) { return frame.times_ms.front(); });
  add(fmt::format("min of {} passes", options.passes), [&](const FlightTrial& f) { return minimum(f.times_ms); });
  add(fmt::format("min of {} passes, CPU time", options.passes),
      [&](const FlightTrial& f) { return minimum(f.cpu_ms); });
  return table;
}

nlohmann::ordered_json frames_json(const FlightTrials& frames) {
  const auto result_json = [](const StageErrors& result) {
    return nlohmann::ordered_json{{"before_roll_rad", json_number(result.before.roll_rad)},
                                  {"before_plane_px", json_number(result.before.plane_px)},
                                  {"after_roll_rad", json_number(result.after.roll_rad)},
                                  {"after_plane_px", json_number(result.after.plane_px)}};
  };
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    all.push_back({{"frame", i},
                   {"reestimated", frames[i].reestimated},
                   {"reason", frames[i].reason},
                   {"tracked", result_json(frames[i].tracked)},
                   {"independent", result_json(frames[i].fresh)},
                   {"times_ms", frames[i].times_ms},
                   {"cpu_ms", frames[i].cpu_ms}});
  }
  return all;
}

/// List of the frames whose road model was re-estimated, with the reason.
std::string reestimated_text(const FlightTrials& frames) {
  std::string text = "Re-estimated:\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].reestimated) text += fmt::format("  frame {}{}\n", i, i == 0 ? "" : ": " + frames[i].reason);
  }
  return text;
}

void run(const FlightArguments& arguments) {
  const FlightTrials frames = run_flight_trials(arguments.flight);
  const Table accuracy = error_table(frames, arguments.flight);
  const Table times = time_table(frames, arguments.flight);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "flight"},
                                  {"rows", accuracy.json()},
                                  {"times", times.json()},
                                  {"frames", frames_json(frames)}});
  }
  fmt::print("{}\n{}\n{}\n{}", accuracy.text(), reestimated_text(frames), times.text(), flight_note);
}

}  // namespace

void add_flight(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand(
      "flight", "Tracking from frame to frame, against ground truth and against independent frames");
  const auto arguments = std::make_shared<FlightArguments>();
  FlightOptions& flight = arguments->flight;
  command->add_option("--scene", flight.scene, "Name of the scene at the start")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--frames", flight.frames, "Number of frames")->type_name("N")->capture_default_str();
  command->add_option("--flight", flight.flight, "Roll, pitch and height of the rig")
      ->type_name("SPEC")
      ->capture_default_str();
  command->add_option("--size", flight.size, "Image size; the field of view does not change")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--preset", flight.preset, "default, fast or paper")->type_name("NAME")->capture_default_str();
  command->add_option("--supersampling", flight.supersampling, "Rays per pixel and axis of the renderer")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--passes", flight.passes, "Number of times each frame is timed")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--cold", flight.cold, "Allocate memory and start threads in the first frame");
  add_method_options(*command, flight.methods);
  command->footer(flight_help() +
                  "\nExample:\n  roadstereo evaluate flight --flight roll=6,jump=150 --json flight.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

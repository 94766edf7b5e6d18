#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "benchmark_report.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/flight_figure.hpp"
#include "evaluate/flight_trials.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "finite_values.hpp"
#include "flight_path.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

struct Arguments {
  FlightOptions flight;
  ReportFiles files;
};

constexpr const char* note =
    R"(plane: largest difference to the true plane over the image, which has no camber. afresh: a pipeline that has seen
no frame before. Times are of the pipeline that carries over, from frames in memory to the result. Every pass is a
pipeline of its own that has seen the same frames. CPU time, of all threads, hardly knows what else the machine does.
Memory and threads are there before the first frame, but for --cold.
)";

using Frames = std::vector<FlightFrame>;
using Stage = RoadError FlightResult::*;
using Figure = double RoadError::*;

std::vector<double> errors(const Frames& frames, FlightResult FlightFrame::*start, Stage stage, Figure figure) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FlightFrame& frame : frames) {
    const double value = (frame.*start).*stage.*figure;
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? NAN : *std::max_element(values.begin(), values.end());
}

/// By how much the error of a frame that was carried over exceeds that of the same frame afresh, at most.
double largest_excess(const Frames& frames, Stage stage, Figure figure) {
  const std::vector<double> carried = errors(frames, &FlightFrame::carried, stage, figure);
  const std::vector<double> fresh = errors(frames, &FlightFrame::fresh, stage, figure);
  std::vector<double> excess;
  for (std::size_t i = 0; i < carried.size(); ++i) excess.push_back(carried[i] - fresh[i]);
  return largest(excess);
}

Table error_table(const Frames& frames, const FlightOptions& options) {
  Table table{fmt::format("{} frames of scene {}, {}, flight {}, preset {}", frames.size(), options.scene, options.size,
                          options.flight, options.preset),
              {{"road model", "road_model"},
               {"start", "start"},
               {"psi 95 % rad", "roll_p95_rad"},
               {"largest", "roll_largest_rad"},
               {"above afresh", "roll_above_fresh_rad"},
               {"plane 95 % px", "plane_p95_px"},
               {"largest", "plane_largest_px"},
               {"above afresh", "plane_above_fresh_px"}},
              {}};
  const auto add = [&](const char* name, const char* start_name, FlightResult FlightFrame::*start, Stage stage) {
    const bool carried = start == &FlightFrame::carried;
    std::vector<Cell> row{name, start_name};
    for (const auto& [figure, decimals] : {std::pair(&RoadError::roll_rad, 5), std::pair(&RoadError::plane_px, 3)}) {
      const std::vector<double> values = errors(frames, start, stage, figure);
      row.emplace_back(quantile(values, 0.95), decimals);
      row.emplace_back(largest(values), decimals);
      row.emplace_back(carried ? largest_excess(frames, stage, figure) : NAN, decimals);
    }
    table.rows.push_back(row);
  };
  add("before matching", "carried over", &FlightFrame::carried, &FlightResult::before);
  add("before matching", "afresh", &FlightFrame::fresh, &FlightResult::before);
  add("after matching", "carried over", &FlightFrame::carried, &FlightResult::after);
  add("after matching", "afresh", &FlightFrame::fresh, &FlightResult::after);
  return table;
}

Table time_table(const Frames& frames, const FlightOptions& options) {
  Table table{fmt::format("Times, {} threads asked for (0: all), {}", options.methods.threads, cpu_name()),
              {{"of a frame", "of_a_frame"},
               {"median ms", "median_ms"},
               {"largest ms", "largest_ms"},
               {"in frame", "largest_frame"},
               {"largest / median", "largest_over_median"},
               {"first frame ms", "first_frame_ms"},
               {"first / median", "first_over_median"}},
              {}};
  const auto add = [&](const std::string& name, const auto& time) {
    std::vector<double> times;
    times.reserve(frames.size());
    for (const FlightFrame& frame : frames) times.push_back(time(frame));
    const auto slowest = std::max_element(times.begin(), times.end());
    const double middle = median(times);
    table.rows.push_back({name, Cell(middle, 2), Cell(*slowest, 2),
                          Cell(static_cast<double>(slowest - times.begin()), 0), Cell(*slowest / middle, 2),
                          Cell(times.front(), 2), Cell(times.front() / middle, 2)});
  };
  const auto least = [](const std::vector<double>& ms) { return *std::min_element(ms.begin(), ms.end()); };
  add("first pass", [](const FlightFrame& frame) { return frame.times_ms.front(); });
  add(fmt::format("least of {} passes", options.passes), [&](const FlightFrame& f) { return least(f.times_ms); });
  add("the same, CPU time", [&](const FlightFrame& f) { return least(f.cpu_ms); });
  return table;
}

nlohmann::ordered_json frames_json(const Frames& frames) {
  const auto result_json = [](const FlightResult& result) {
    return nlohmann::ordered_json{{"before_roll_rad", json_number(result.before.roll_rad)},
                                  {"before_plane_px", json_number(result.before.plane_px)},
                                  {"after_roll_rad", json_number(result.after.roll_rad)},
                                  {"after_plane_px", json_number(result.after.plane_px)}};
  };
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    all.push_back({{"frame", i},
                   {"estimated_anew", frames[i].estimated_anew},
                   {"reason", frames[i].reason},
                   {"carried", result_json(frames[i].carried)},
                   {"fresh", result_json(frames[i].fresh)},
                   {"times_ms", frames[i].times_ms},
                   {"cpu_ms", frames[i].cpu_ms}});
  }
  return all;
}

/// The frames whose road model was estimated anew, and why.
std::string anew_text(const Frames& frames) {
  std::string text = "Estimated anew:\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].estimated_anew) text += fmt::format("  frame {}{}\n", i, i == 0 ? "" : ": " + frames[i].reason);
  }
  return text;
}

void run(const Arguments& arguments) {
  const Frames frames = fly(arguments.flight);
  const Table accuracy = error_table(frames, arguments.flight);
  const Table times = time_table(frames, arguments.flight);
  if (!arguments.files.json.empty()) {
    write_report(arguments.files.json, {{"experiment", "flight"},
                                        {"rows", accuracy.json()},
                                        {"times", times.json()},
                                        {"frames", frames_json(frames)}});
  }
  if (!arguments.files.figure.empty()) write_figure(arguments.files.figure, draw_flight(frames));
  fmt::print("{}\n{}\n{}\n{}", accuracy.text(), anew_text(frames), times.text(), note);
}

}  // namespace

void add_flight(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand(
      "flight", "What carries over from frame to frame, against the truth and against single frames");
  const auto arguments = std::make_shared<Arguments>();
  FlightOptions& flight = arguments->flight;
  command->add_option("--scene", flight.scene, "The named scene where it starts")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--frames", flight.frames, "Frames of the flight")->type_name("N")->capture_default_str();
  command->add_option("--flight", flight.flight, "How the rig rolls, pitches and climbs")
      ->type_name("SPEC")
      ->capture_default_str();
  command->add_option("--size", flight.size, "Image size; the field of view stays")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--preset", flight.preset, "default, fast or paper")->type_name("NAME")->capture_default_str();
  command->add_option("--supersampling", flight.supersampling, "Rays per pixel and side when frames are made")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--passes", flight.passes, "How often each frame is timed")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--cold", flight.cold, "The first frame also makes the memory and starts the threads");
  add_method_options(*command, flight.methods);
  command->footer(flight_help() +
                  "\nExample:\n  roadstereo evaluate flight --flight roll=6,jump=150 --figure flight.png");
  add_report_options(*command, arguments->files);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../benchmark_frames.hpp"
#include "../benchmark_report.hpp"
#include "../image_size.hpp"
#include "../stopwatch.hpp"
#include "experiments.hpp"
#include "report.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/peer_matchers.hpp"
#include "roadstereo/io/plot.hpp"
#include "table.hpp"

namespace roadstereo::cli {
namespace {

/// What the paper measured on a Jetson TX2. D is not given there: 49.231 Mde/s · 152.889 ms / (695 · 361) = 30.
struct Published {
  double total_ms = 152.889;
  double mde_per_s = 49.231;
  double roll_ms = 7.842;
  double transform_ms = 1.541;
};

struct Arguments {
  std::string size = "695x361";
  int disparities = 30;
  int runs = 15;
  int threads = 0;
  ReportFiles files;

  void validate() const {
    if (disparities < 1 || disparities > 1024)
      fail("--disparities is ", disparities, "; it must be between 1 and 1024");
    if (runs < 1 || runs > 100000) fail("--runs is ", runs, "; it must be between 1 and 100000");
  }
};

/// One of our ways to run, timed.
struct TimedPipeline {
  std::string name;
  Pipeline pipeline;
  Timing total{}, roll{}, transform{};
};

struct TimedPeer {
  std::string name;
  io::PeerMatcher matcher;
  Timing total{};
};

struct RuntimeReport {
  int width = 0, height = 0, disparities = 0, threads = 0;
  std::vector<TimedPipeline> pipelines;
  std::vector<TimedPeer> peers;

  double mde_per_s(double ms) const { return static_cast<double>(width) * height * disparities * 1e-6 / (ms * 1e-3); }
};

TimedPipeline make_pipeline(const std::string& name, bool narrow_search, const Arguments& arguments,
                            const StereoPair& pair) {
  PipelineOptions options = preset(name);
  options.threads = arguments.threads;
  options.narrow_search = narrow_search;
  options.perspective.disparities = arguments.disparities;
  return {narrow_search ? name : name + ", all D", Pipeline(options, pair.calibration)};
}

/// All in turn, so that all see the same machine; the first run of each is left out.
RuntimeReport measure(const Arguments& arguments) {
  const ImageSize size = parse_image_size(arguments.size);
  const StereoPair pair = synthetic_pair(size.width, size.height);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  RuntimeReport report{
      size.width, size.height, arguments.disparities, arguments.threads > 0 ? arguments.threads : cores, {}, {}};
  for (const char* name : {"default", "fast", "paper"}) {
    for (const bool narrow : {true, false}) report.pipelines.push_back(make_pipeline(name, narrow, arguments, pair));
  }
  const auto process = [&](TimedPipeline& timed) -> const FrameResult& {
    return timed.pipeline.process(pair.left.view(), pair.right.view());
  };
  for (TimedPipeline& timed : report.pipelines) process(timed);
  const PeerPair grey = peer_pair(pair, process(report.pipelines.front()).shift);
  for (const std::string& name : io::peer_names()) {
    report.peers.push_back({name, io::PeerMatcher(name, report.disparities)});
    report.peers.back().matcher.set_pair(grey.reference, grey.target);
    report.peers.back().matcher.match();
  }
  for (int run = 0; run < arguments.runs; ++run) {
    for (TimedPipeline& timed : report.pipelines) {
      const FrameResult* result = nullptr;
      timed.total.ms.push_back(time_ms([&] { result = &process(timed); }));
      timed.roll.ms.push_back(result->ms.road_geometry);
      timed.transform.ms.push_back(result->ms.transform);
    }
    for (TimedPeer& timed : report.peers) timed.total.ms.push_back(time_ms([&] { timed.matcher.match(); }));
  }
  return report;
}

Table make_table(const RuntimeReport& report) {
  Table table{fmt::format("{}×{}, D {}, {} threads, {}; medians", report.width, report.height, report.disparities,
                          report.threads, cpu_name()),
              {{"method", "method"},
               {"total ms", "total_ms"},
               {"min ms", "fastest_ms"},
               {"Mde/s", "mde_per_s"},
               {"roll ms", "roll_ms"},
               {"transform ms", "transform_ms"}},
              {}};
  for (const TimedPeer& peer : report.peers) table.columns.push_back({"/ " + peer.name, "ratio_to_" + peer.name});
  const auto add = [&](const std::string& name, double total, double fastest, double mde, double roll,
                       double transform) {
    std::vector<Cell> row{name,          Cell(total, 2),    Cell(fastest, 2), Cell(mde, mde < 100 ? 3 : 0),
                          Cell(roll, 3), Cell(transform, 3)};
    for (const TimedPeer& peer : report.peers) row.emplace_back(total / peer.total.median(), 2);
    table.rows.push_back(row);
  };
  for (const TimedPipeline& timed : report.pipelines) {
    add(timed.name, timed.total.median(), timed.total.fastest(), report.mde_per_s(timed.total.median()),
        timed.roll.median(), timed.transform.median());
  }
  for (const TimedPeer& peer : report.peers) {
    add("OpenCV " + peer.name, peer.total.median(), peer.total.fastest(), report.mde_per_s(peer.total.median()), NAN,
        NAN);
  }
  const Published published;
  std::vector<Cell> row{"published: Jetson TX2, 695×361", Cell(published.total_ms, 3), Cell(NAN, 2),
                        Cell(published.mde_per_s, 3),     Cell(published.roll_ms, 3),  Cell(published.transform_ms, 3)};
  row.resize(table.columns.size(), Cell(NAN, 2));
  table.rows.push_back(row);
  return table;
}

constexpr const char* note =
    "Whole frames whose road model is known from the frame before; OpenCV matches the pair already transformed, both\n"
    "searching D (OpenCV rounds up to a multiple of 16), and SGBM runs on one thread. Mde/s is W·H·D/t as the paper\n"
    "defines it, although a narrowed search evaluates fewer; \", all D\" evaluates every one. roll is the preset's\n"
    "solver: gradient descent for paper, as published.\n";

Frame draw(const RuntimeReport& report) {
  io::BarGroups bars{fmt::format("Time per frame, {}x{}, D {}", report.width, report.height, report.disparities),
                     "median, ms",
                     {},
                     {"total"},
                     {{}}};
  for (const TimedPipeline& timed : report.pipelines) {
    bars.groups.push_back(timed.name);
    bars.values[0].push_back(timed.total.median());
  }
  for (const TimedPeer& peer : report.peers) {
    bars.groups.push_back(peer.name);
    bars.values[0].push_back(peer.total.median());
  }
  bars.groups.emplace_back("Jetson TX2");
  bars.values[0].push_back(Published{}.total_ms);
  return io::draw_bars(bars);
}

void run(const Arguments& arguments) {
  arguments.validate();
  const RuntimeReport report = measure(arguments);
  const Table table = make_table(report);
  if (!arguments.files.json.empty()) {
    write_report(arguments.files.json, {{"experiment", "runtime"},
                                        {"width", report.width},
                                        {"height", report.height},
                                        {"disparities", report.disparities},
                                        {"threads", report.threads},
                                        {"cpu", cpu_name()},
                                        {"runs", arguments.runs},
                                        {"rows", table.json()}});
  }
  if (!arguments.files.figure.empty()) write_figure(arguments.files.figure, draw(report));
  fmt::print("{}\n{}", table.text(), note);
}

}  // namespace

void add_runtime(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("runtime", "Time per frame and Mde/s of every preset beside OpenCV's matchers");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--size", arguments->size, "Size of the synthetic frame; the paper's by default")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--disparities", arguments->disparities, "Disparities searched; the paper's Mde/s implies 30")
      ->type_name("D")
      ->capture_default_str();
  command->add_option("--runs", arguments->runs, "Frames timed")->type_name("N")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Worker threads of the pipeline; 0 takes all cores")
      ->capture_default_str();
  add_report_options(*command, arguments->files);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "evaluate/runtime_trials.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {
namespace {

/// Published values, on a Jetson TX2.
struct Published {
  double total_ms = 152.889;
  double mde_per_s = 49.231;
  double roll_ms = 7.842;
  double transform_ms = 1.541;
};

struct RuntimeArguments {
  RuntimeOptions runtime;
  std::string json;
};

Table make_table(const RuntimeReport& report) {
  Table table{fmt::format("{}×{}, D {}, {} threads, {}; medians", report.width, report.height, report.disparities,
                          report.threads, cpu_name()),
              {{"method", "method"},
               {"total ms", "total_ms"},
               {"min ms", "min_ms"},
               {"Mde/s", "mde_per_s"},
               {"roll ms", "roll_ms"},
               {"transform ms", "transform_ms"}},
              {}};
  for (const Timing& baseline : report.baselines) {
    table.columns.push_back({"/ " + baseline.name, "ratio_to_" + baseline.name});
  }
  const auto add = [&](const std::string& name, double total, double fastest, double mde, double roll,
                       double transform) {
    std::vector<Cell> row{name,          Cell(total, 2),    Cell(fastest, 2), Cell(mde, mde < 100 ? 3 : 0),
                          Cell(roll, 3), Cell(transform, 3)};
    for (const Timing& baseline : report.baselines) row.emplace_back(total / baseline.median(), 2);
    table.rows.push_back(row);
  };
  for (const PipelineTimes& timed : report.pipelines) {
    add(timed.name, timed.total.median(), timed.total.fastest(), report.mde_per_s(timed.total.median()),
        timed.roll.median(), timed.transform.median());
  }
  for (const Timing& baseline : report.baselines) {
    add("OpenCV " + baseline.name, baseline.median(), baseline.fastest(), report.mde_per_s(baseline.median()), NAN,
        NAN);
  }
  const Published published;
  std::vector<Cell> row{"published: Jetson TX2, 695×361", Cell(published.total_ms, 3), Cell(NAN, 2),
                        Cell(published.mde_per_s, 3),     Cell(published.roll_ms, 3),  Cell(published.transform_ms, 3)};
  row.resize(table.columns.size(), Cell(NAN, 2));
  table.rows.push_back(row);
  return table;
}

constexpr const char* runtime_note =
    "Times of complete frames with a tracked road model. OpenCV matches the transformed pair. All search D "
    "disparities;\n"
    "OpenCV rounds D up to a multiple of 16, and SGBM runs on one thread. Mde/s is W·H·D/t as in the paper, although "
    "a\n"
    "narrowed search evaluates fewer disparities; \", all D\" evaluates all of them. roll: the solver of the preset; "
    "that "
    "of\n"
    "paper is gradient descent, as published.\n";

void run(const RuntimeArguments& arguments) {
  const RuntimeReport report = time_methods(arguments.runtime);
  const Table table = make_table(report);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "runtime"},
                                  {"width", report.width},
                                  {"height", report.height},
                                  {"disparities", report.disparities},
                                  {"threads", report.threads},
                                  {"cpu", cpu_name()},
                                  {"runs", arguments.runtime.runs},
                                  {"rows", table.json()}});
  }
  fmt::print("{}\n{}", table.text(), runtime_note);
}

}  // namespace

void add_runtime(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("runtime", "Time per frame and Mde/s of every preset and of OpenCV's matchers");
  const auto arguments = std::make_shared<RuntimeArguments>();
  command->add_option("--size", arguments->runtime.size, "Size of the synthetic frame; default: as in the paper")
      ->type_name("WxH")
      ->capture_default_str();
  command
      ->add_option("--disparities", arguments->runtime.disparities,
                   "Number of disparities; the Mde/s of the paper implies 30")
      ->type_name("D")
      ->capture_default_str();
  command->add_option("--runs", arguments->runtime.runs, "Number of timed frames")
      ->type_name("N")
      ->capture_default_str();
  add_method_options(*command, arguments->runtime.methods);
  command->footer("Example:\n  roadstereo evaluate runtime --size 1242x375 --disparities 64");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

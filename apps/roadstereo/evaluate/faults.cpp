#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/fault_trials.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

struct FaultArguments {
  std::string only;
  int pictures = 10;
  bool list_warnings = false;
  MethodSettings methods;
  std::string json;
};

constexpr const char* fault_note =
    "found: a region covers at least a third of a pothole or bump. invented: less than a tenth of a region lies "
    "within\n"
    "4 pixels of any. graded: with a severity from minor to high. within 2: depths of found and graded damages within\n"
    "two standard errors of the truth. warned: pictures with a warning. deepest: of the invented.\n";

std::vector<Cell> row_of(const std::string& name, const FaultCounts& counts) {
  constexpr double mm = 1000;
  return {name,
          Cell(counts.in_view, 0),
          Cell(counts.found, 0),
          Cell(counts.invented, 0),
          Cell(counts.invented_graded, 0),
          Cell(mm * counts.deepest_m, 0),
          Cell(counts.depths, 0),
          Cell(counts.depths_within_2, 0),
          Cell(counts.warned, 0)};
}

void run_faults(const FaultArguments& arguments) {
  if (arguments.pictures < 1 || arguments.pictures > 100000) {
    fail("--pictures is ", arguments.pictures, "; it must be between 1 and 100000");
  }
  Table table{fmt::format("Faults of a rig, {} pictures each", arguments.pictures),
              {{"fault", "fault"},
               {"in view", "in_view"},
               {"found", "found"},
               {"invented", "false_invented"},
               {"graded", "false_graded"},
               {"deepest mm", "deepest_mm"},
               {"depths", "depths"},
               {"within 2", "within_2_std_errors"},
               {"warned", "warned"}},
              {}};
  std::string warnings;
  Progress progress = Progress::on_terminal(faults().size());
  for (const Fault& fault : faults()) {
    progress.frame_done();
    if (fault.name.find(arguments.only) == std::string::npos) continue;
    const FaultCounts counts = run_fault(fault, arguments.pictures, arguments.methods);
    table.rows.push_back(row_of(fault.name, counts));
    for (const std::string& warning : counts.warnings) warnings += fmt::format("{}: {}\n", fault.name, warning);
  }
  progress.end();
  if (table.rows.empty()) fail("--only is \"", arguments.only, "\"; no fault has that in its name");
  fmt::print("{}\n{}", table.text(), fault_note);
  if (arguments.list_warnings) fmt::print("\n{}", warnings);
  if (arguments.json.empty()) return;
  write_report(arguments.json, {{"experiment", "faults"}, {"pictures", arguments.pictures}, {"rows", table.json()}});
}

}  // namespace

void add_faults(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand(
      "faults", "Damage found and invented when rig, weather or files are at fault, on ten synthetic roads");
  const auto arguments = std::make_shared<FaultArguments>();
  command->add_option("--pictures", arguments->pictures, "Pictures per fault; the ten roads in turn")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--only", arguments->only, "Only faults with this in their name")->type_name("TEXT");
  command->add_flag("--warnings", arguments->list_warnings, "Also print the first warning of each kind");
  add_method_options(*command, arguments->methods);
  add_json_option(*command, arguments->json);
  command->footer("Example:\n  roadstereo evaluate faults --only streaks --pictures 100 --warnings");
  command->callback([arguments] { run_faults(*arguments); });
}

}  // namespace roadstereo::cli

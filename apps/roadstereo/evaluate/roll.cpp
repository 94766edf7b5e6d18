#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "evaluate/roll_trials.hpp"
#include "evaluate/table.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

constexpr double published_mean_rad = 0.012;

struct RollArguments {
  RollTrialOptions trials;
  bool no_pairs = false;
  std::string json;

  void validate() const {
    constexpr double limit_deg = 45;
    if (!(trials.max_roll_deg > 0 && trials.max_roll_deg <= limit_deg)) {
      fail("--max-roll is ", trials.max_roll_deg, "; it must be above 0 and at most ", limit_deg);
    }
    if (trials.angles < 1 || trials.angles > 1000) {
      fail("--angles is ", trials.angles, "; it must be between 1 and 1000");
    }
  }
};

constexpr const char* roll_note =
    "Rows with camber: the road is not planar (1 cm lower 1.6 m beside its crown). The true roll is that of the "
    "tangent\n"
    "plane at the crown; the visible part of the road is not symmetric, which biases the best plane. lost: pairs "
    "whose\n"
    "road was not found, which are no trials.\n";

Table make_table(const std::vector<RollErrors>& all) {
  Table table{"Error of the roll angle, rad",
              {{"maps", "maps"},
               {"solver", "solver"},
               {"trials", "trials"},
               {"lost", "lost"},
               {"mean", "mean_rad"},
               {"max", "max_rad"}},
              {{"published: EISATS, rotated", "gradient_descent", Cell(NAN, 0), Cell(NAN, 0),
                Cell(published_mean_rad, 3), Cell(NAN, 6)}}};
  for (const RollErrors& errors : all) {
    table.rows.push_back({errors.maps, errors.solver, Cell(static_cast<double>(errors.error_rad.size()), 0),
                          Cell(errors.lost, 0), Cell(errors.mean_rad(), 6), Cell(errors.max_rad(), 6)});
  }
  return table;
}

nlohmann::ordered_json trials_json(const std::vector<RollErrors>& all) {
  nlohmann::ordered_json trials = nlohmann::ordered_json::array();
  for (const RollErrors& errors : all) {
    trials.push_back({{"maps", errors.maps},
                      {"solver", errors.solver},
                      {"roll_deg", errors.roll_deg},
                      {"error_rad", errors.error_rad}});
  }
  return trials;
}

void run(const RollArguments& arguments) {
  arguments.validate();
  std::vector<RollErrors> all = run_exact_trials(arguments.trials);
  if (!arguments.no_pairs) {
    for (RollErrors& errors : run_matched_trials(arguments.trials)) all.push_back(std::move(errors));
  }
  const Table table = make_table(all);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "roll"}, {"rows", table.json()}, {"trials", trials_json(all)}});
  }
  fmt::print("{}\n{}", table.text(), roll_note);
}

}  // namespace

void add_roll(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("roll", "Error of the roll angle on synthetic roads with known roll");
  const auto arguments = std::make_shared<RollArguments>();
  command->add_option("--max-roll", arguments->trials.max_roll_deg, "Maximum roll of exact maps, in both directions")
      ->type_name("DEG")
      ->capture_default_str();
  command->add_option("--angles", arguments->trials.angles, "Number of angles per view")->capture_default_str();
  command->add_flag("--no-pairs", arguments->no_pairs, "Exact maps only, without matching");
  add_method_options(*command, arguments->trials.methods);
  command->get_option("--no-pairs")->excludes("--set");
  command->footer("Example:\n  roadstereo evaluate roll --json roll.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

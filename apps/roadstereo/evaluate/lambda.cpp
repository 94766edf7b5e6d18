#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/experiments.hpp"
#include "evaluate/lambda_sweep.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {
namespace {

constexpr double published_optimum = 10;

struct LambdaArguments {
  double min_lambda = 0.01;
  double max_lambda = 1e4;
  int count = 25;
  int threads = 0;
  std::string json;

  void validate() const {
    constexpr double limit = 1e6;  // of roll.initial_lambda
    if (!(min_lambda > 0 && min_lambda < max_lambda && max_lambda <= limit)) {
      fail("--min-lambda ", min_lambda, " and --max-lambda ", max_lambda,
           " must be above 0, in this order, and at most ", limit);
    }
    if (count < 2 || count > 1000) fail("--count is ", count, "; it must be between 2 and 1000");
  }
};

constexpr const char* lambda_note =
    "The energy is normalised so that λ = 10 is a Newton step for a road without roll (docs/method.md). An optimum at "
    "10\n"
    "confirms this normalisation; the one of the paper is not published. From the second step on, eq. (28),\n"
    "adaptive_lambda, makes λ a secant step for any λ(0), so that λ(0) costs about one iteration at most. The first "
    "step "
    "is\n"
    "limited to π/8 and halved until the energy decreases, within one iteration, so that all large λ(0) are "
    "equivalent.\n";

Table make_table(const std::vector<LambdaTrial>& trials, std::size_t maps) {
  Table table{
      fmt::format("Iterations of the gradient descent against λ(0), {} maps, δψ = π/1.8e6", maps),
      {{"λ(0)", "lambda"}, {"mean", "mean_iterations"}, {"max", "max_iterations"}, {"max error rad", "max_error_rad"}},
      {}};
  for (const LambdaTrial& trial : trials) {
    table.rows.push_back(
        {Cell(trial.lambda, 3), Cell(trial.mean(), 2), Cell(trial.max(), 0), Cell(trial.max_error_rad, 9)});
  }
  return table;
}

void run(const LambdaArguments& arguments) {
  arguments.validate();
  const std::vector<LambdaMap> maps = make_lambda_maps(arguments.threads);
  std::vector<LambdaTrial> trials;
  for (const double lambda : geometric_series(arguments.min_lambda, arguments.max_lambda, arguments.count)) {
    trials.push_back(run_lambda_trial(lambda, maps, RollOptions{}.roll_threshold_rad, arguments.threads));
  }
  const double optimum = best_lambda(trials);
  const Table table = make_table(trials, maps.size());
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "lambda"},
                                  {"maps", maps.size()},
                                  {"optimum", optimum},
                                  {"published_optimum", published_optimum},
                                  {"rows", table.json()}});
  }
  fmt::print("{}\nOptimum {:.3g}; the paper's is {}.\n{}", table.text(), optimum, published_optimum, lambda_note);
}

}  // namespace

void add_lambda(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("lambda", "Iterations of the gradient descent on the roll angle against λ(0)");
  const auto arguments = std::make_shared<LambdaArguments>();
  command->add_option("--min-lambda", arguments->min_lambda, "Minimum λ(0)")->capture_default_str();
  command->add_option("--max-lambda", arguments->max_lambda, "Maximum λ(0)")->capture_default_str();
  command->add_option("--count", arguments->count, "Number of values, with equal ratios")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Worker threads; 0: all cores")->capture_default_str();
  command->footer("Example:\n  roadstereo evaluate lambda --json lambda.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli

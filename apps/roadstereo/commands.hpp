#pragma once

namespace CLI {
class App;
}

namespace roadstereo::cli {

// Each adds one subcommand to the command line. The subcommand runs when it is parsed.
void add_inspect(CLI::App& app);
void add_live(CLI::App& app);
void add_damage(CLI::App& app);
void add_map(CLI::App& app);
void add_synth(CLI::App& app);
void add_limits(CLI::App& app);
void add_options(CLI::App& app);
void add_completion(CLI::App& app);
void add_engines(CLI::App& app);
void add_benchmark(CLI::App& app);
void add_evaluate(CLI::App& app);

}  // namespace roadstereo::cli

#pragma once

namespace CLI {
class App;
}

namespace roadstereo::cli {

// Each function adds one experiment as a subcommand of `evaluate`.
void add_paper(CLI::App& evaluate);
void add_kitti(CLI::App& evaluate);
void add_middlebury(CLI::App& evaluate);
void add_score(CLI::App& evaluate);
void add_synth_accuracy(CLI::App& evaluate);
void add_sigma(CLI::App& evaluate);
void add_subpixel(CLI::App& evaluate);
void add_ablation(CLI::App& evaluate);
void add_lambda(CLI::App& evaluate);
void add_roll(CLI::App& evaluate);
void add_flatness(CLI::App& evaluate);
void add_blur(CLI::App& evaluate);
void add_damage_accuracy(CLI::App& evaluate);
void add_faults(CLI::App& evaluate);
void add_scan(CLI::App& evaluate);
void add_flight(CLI::App& evaluate);
void add_runtime(CLI::App& evaluate);
void add_odometry(CLI::App& evaluate);
void add_robustness(CLI::App& evaluate);
void add_map_accuracy(CLI::App& evaluate);

}  // namespace roadstereo::cli

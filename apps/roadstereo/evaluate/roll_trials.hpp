#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {

/// Errors of the roll angle of one solver on one kind of map.
struct RollErrors {
  std::string maps;               ///< name of the kind
  std::string solver;             ///< value of `--set roll.solver`
  std::vector<double> roll_deg;   ///< true roll of each trial
  std::vector<double> error_rad;  ///< estimated minus true
  int lost = 0;                   ///< pairs whose road was not found, which have no error
  double mean_rad() const;        ///< mean magnitude
  double max_rad() const;         ///< maximum magnitude
};

struct RollTrialOptions {
  double max_roll_deg = 20;  ///< of exact maps, in both directions
  int angles = 9;            ///< number of angles from −max to +max, 1 … 1000
  MethodSettings methods;    ///< threads, and options of the presets that match pairs
};

struct NamedSolver {
  const char* name;
  RollSolver solver;
};
const std::vector<NamedSolver>& roll_solvers();

/// Estimate the roll on exact disparity maps under known rolls: clean, with damage, with damage and outliers, and of a
/// cambered road, which is not planar. Maps are made in two ways: with a rolled rig, and as in the paper by rotating a
/// map without roll about the centre of the image.
std::vector<RollErrors> run_exact_trials(const RollTrialOptions& options);

/// Estimate the roll of rendered pairs with damage and noise, on a flat and on a cambered road: by the default preset,
/// by the paper's solver on its disparities, and by the paper's preset.
std::vector<RollErrors> run_matched_trials(const RollTrialOptions& options);

}  // namespace roadstereo::cli

#pragma once

#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "roadstereo/road_geometry.hpp"

namespace roadstereo::cli {

/// Angles between the true roll and the one found, on one kind of map by one solver.
struct RollErrors {
  std::string maps;               ///< what they are
  std::string solver;             ///< as `--set road_geometry.solver` spells it
  std::vector<double> roll_deg;   ///< of each trial
  std::vector<double> error_rad;  ///< found minus true
  double mean_rad() const;        ///< of the magnitudes
  double largest_rad() const;
};

struct RollTrialOptions {
  double largest_roll_deg = 20;          ///< of exact maps, both ways
  double largest_matched_roll_deg = 10;  ///< of matched pairs
  int angles = 9;                        ///< from −largest to +largest
  MethodSettings methods;                ///< threads, and options of the default pipeline
};

/// A solver by its name.
struct NamedSolver {
  const char* name;
  RollSolver solver;
};
const std::vector<NamedSolver>& roll_solvers();

/// Exact disparity maps of roads seen under known rolls: clean, with damage, with damage and outliers, and with a
/// cambered road, which is no plane. Each once with the rig rolled and once as the paper does it: a map without roll,
/// rotated about the centre of the image.
std::vector<RollErrors> try_exact_maps(const RollTrialOptions& options);

/// Rendered pairs with damage and noise through the default pipeline, on a flat and on a cambered road.
std::vector<RollErrors> try_matched_maps(const RollTrialOptions& options);

}  // namespace roadstereo::cli

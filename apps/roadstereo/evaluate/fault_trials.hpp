#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluate/methods.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Something wrong with a rig or the weather. `apply` changes images or calibration; `seed` draws where.
struct Fault {
  std::string name;
  std::function<void(synth::SyntheticPair& pair, std::uint32_t seed)> apply;
};

/// All faults, by kind and growing strength; the first is none at all.
const std::vector<Fault>& faults();

/// Counts over the pictures of one fault.
struct FaultCounts {
  int pictures = 0;
  int in_view = 0;                    ///< potholes and bumps
  int found = 0;                      ///< of them: a region covers at least a third
  int invented = 0;                   ///< regions with less than a tenth within 4 pixels of any damage
  int invented_graded = 0;            ///< of them, with a severity: minor … high
  double deepest_m = 0;               ///< of the invented ones
  int depths = 0;                     ///< found damages with a severity
  int depths_within_2 = 0;            ///< of them, depths within two standard errors of the truth
  int warned = 0;                     ///< pictures with a warning
  std::vector<std::string> warnings;  ///< the first of each kind
};

/// Run the default preset on `pictures` pairs of ten rendered roads in turn, each with the fault drawn anew.
FaultCounts run_fault(const Fault& fault, int pictures, const MethodSettings& settings);

}  // namespace roadstereo::cli

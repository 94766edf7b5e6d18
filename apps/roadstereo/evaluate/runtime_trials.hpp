#pragma once

#include <string>
#include <vector>

#include "benchmark_report.hpp"
#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct RuntimeOptions {
  std::string size = "695x361";  ///< the paper's
  int disparities = 30;          ///< what its figures imply: 49.231 Mde/s · 152.889 ms / (695 · 361)
  int runs = 15;
  MethodSettings methods;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// A preset, timed.
struct PipelineTimes {
  std::string name;
  Timing total;
  Timing roll;       ///< roll and projection model
  Timing transform;  ///< disparity transformation
};

struct RuntimeReport {
  int width = 0, height = 0, disparities = 0, threads = 0;
  std::vector<PipelineTimes> pipelines;
  std::vector<Timing> peers;

  /// W·H·D / t, millions per second.
  double mde_per_s(double ms) const;
};

/// Times every preset, with the search narrowed and over all D, and OpenCV's matchers in turn on the same frames, so
/// that all see the same machine. The first run of each is left out, and with it the search for the road model.
RuntimeReport time_methods(const RuntimeOptions& options);

}  // namespace roadstereo::cli

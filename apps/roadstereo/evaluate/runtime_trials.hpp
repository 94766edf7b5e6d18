#pragma once

#include <string>
#include <vector>

#include "benchmark_report.hpp"
#include "evaluate/methods.hpp"

namespace roadstereo::cli {

struct RuntimeOptions {
  std::string size = "695x361";  ///< as in the paper
  int disparities = 30;          ///< implied by the paper: 49.231 Mde/s · 152.889 ms / (695 · 361); 1 … 1024
  int runs = 15;                 ///< timed frames, 1 … 100000
  MethodSettings methods;

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Times of a preset.
struct PipelineTimes {
  std::string name;
  Timing total;
  Timing roll;       ///< roll and projection model
  Timing transform;  ///< disparity transformation
};

struct RuntimeReport {
  int width = 0, height = 0, disparities = 0, threads = 0;
  std::vector<PipelineTimes> pipelines;
  std::vector<Timing> baselines;

  /// Million disparity evaluations per second: W·H·D / t.
  double mde_per_s(double ms) const;
};

/// Time every preset, with and without narrowed search, and OpenCV's matchers. Methods alternate frame by frame, so
/// that all run under the same load. The first run of each, which estimates the road model, is not timed.
RuntimeReport time_methods(const RuntimeOptions& options);

}  // namespace roadstereo::cli

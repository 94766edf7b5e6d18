#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Times of many runs of one thing, milliseconds.
struct Timing {
  std::string name;
  std::vector<double> ms;

  double median() const;
  double fastest() const;
  double slowest() const;
};

/// What `benchmark` measures.
struct BenchmarkReport {
  int width = 0, height = 0, disparities = 0;
  std::string preset, engine, target, cpu;
  int threads = 0;
  std::vector<Timing> stages;  ///< of frames whose road model is known from the frame before
  Timing total{"total", {}};
  Timing first{"first frame", {}};  ///< road model found anew
  std::vector<Timing> baselines;
  std::optional<double> allocations;         ///< per frame
  std::optional<std::size_t> scratch_bytes;  ///< most in use beyond what was there before the pipeline was made
  std::size_t peak_memory_bytes = 0;         ///< of the whole process

  double mde_per_s() const;
};

/// Name of the processor; "unknown" where the system does not say.
std::string cpu_name();

std::string report_text(const BenchmarkReport& report);
std::string report_json(const BenchmarkReport& report);

}  // namespace roadstereo::cli

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/device.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// Times of repeated runs, milliseconds.
struct Timing {
  std::string name;
  std::vector<double> ms;

  double median() const;
  double fastest() const;
  double slowest() const;
};

/// Results of `benchmark`.
struct BenchmarkReport {
  int width = 0, height = 0, disparities = 0;
  std::string preset, engine, target, cpu;
  int threads = 0;
  std::vector<Timing> stages;  ///< of frames whose road model is known from the previous frame
  Timing total{"total", {}};
  Timing first{"first frame", {}};  ///< road model estimated
  std::vector<Timing> baselines;
  int raw_disparities = 0;  ///< that OpenCV's matchers search in the pair as it is; 0: in the transformed pair
  std::optional<double> allocations;         ///< per frame
  std::optional<DeviceProfile> device;       ///< of a frame of its own, with the engine cuda
  std::optional<std::size_t> scratch_bytes;  ///< maximum in use, minus the use before the pipeline was created
  std::size_t peak_memory_bytes = 0;         ///< of the whole process

  double mde_per_s() const;
};

/// Returns the name of the processor or "unknown".
std::string cpu_name();

std::string report_text(const BenchmarkReport& report);
std::string report_json(const BenchmarkReport& report);

}  // namespace roadstereo::cli

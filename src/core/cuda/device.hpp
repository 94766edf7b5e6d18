#pragma once

#include <string>

namespace roadstereo::cuda {

/// The GPU that this process would use, or why it cannot use one.
struct Device {
  bool usable = false;
  std::string name;    ///< e.g. "NVIDIA H200 (compute capability 9.0)"; empty when not usable
  std::string reason;  ///< why not, as a sentence; empty when usable
  int multiprocessors = 0;
  int shared_bytes = 0;  ///< most shared memory of a block
};

/// Asks the driver for the current device, and whether this binary carries code for it.
Device find_device();

}  // namespace roadstereo::cuda

#pragma once

namespace roadstereo::cli {

/// Memory use of the process, MiB; 0: unknown.
struct MemoryUse {
  double now_mib = 0;
  double peak_mib = 0;
};

MemoryUse memory_use();

}  // namespace roadstereo::cli

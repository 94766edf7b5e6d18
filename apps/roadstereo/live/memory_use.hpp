#pragma once

namespace roadstereo::cli {

/// Of this process, MiB; 0 where the system does not tell.
struct MemoryUse {
  double now_mib = 0;
  double peak_mib = 0;
};

MemoryUse memory_use();

}  // namespace roadstereo::cli

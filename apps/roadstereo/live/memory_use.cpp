#include "live/memory_use.hpp"

#include <fstream>
#include <string>

namespace roadstereo::cli {

MemoryUse memory_use() {
  constexpr double kib = 1024;  // in a MiB
  MemoryUse use;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:" && status >> use.now_mib) use.now_mib /= kib;
    if (word == "VmHWM:" && status >> use.peak_mib) use.peak_mib /= kib;
  }
  return use;
}

}  // namespace roadstereo::cli

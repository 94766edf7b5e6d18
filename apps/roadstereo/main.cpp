#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "command_line.hpp"

namespace {

/// Keeps what is freed for the next frame: the system takes about as long to give new pages as it takes to fill them.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_kept_bytes = 32 << 20, kept_bytes = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, largest_kept_bytes);
  mallopt(M_TRIM_THRESHOLD, kept_bytes);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  return roadstereo::cli::run_command_line(argc, argv);
}

#include "lower_priority.hpp"

#include <sys/resource.h>
#include <unistd.h>

namespace roadstereo::cli {

void lower_priority() {
  constexpr int nice = 10;
  // Linux applies this to the calling thread. Errors are ignored.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

}  // namespace roadstereo::cli

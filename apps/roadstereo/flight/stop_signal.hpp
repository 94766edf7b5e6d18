#pragma once

namespace roadstereo::cli {

/// While it lives, Ctrl-C and SIGTERM ask for a stop instead of killing the program; a second one kills it.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal();

  bool requested() const;
};

}  // namespace roadstereo::cli

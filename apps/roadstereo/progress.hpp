#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace roadstereo::cli {

/// Progress of a flight or an experiment on standard error: a bar with the time left on a terminal, else a line every
/// few seconds.
class Progress {
 public:
  /// `total` frames, `done` of them by an earlier run. Prints nothing if `quiet`.
  Progress(std::optional<std::int64_t> total, std::int64_t done, bool quiet);
  /// Progress that is printed on a terminal only.
  static Progress on_terminal(std::size_t total, bool quiet = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void frame_done(bool good = true);

  /// Ends the current line.
  void end();

  double seconds() const;
  double frames_per_second() const;

 private:
  void show();
  std::string line() const;
  std::string bar() const;

  std::optional<std::int64_t> total_;
  std::int64_t before_;  ///< frames of an earlier run
  std::int64_t done_ = 0;
  std::int64_t bad_ = 0;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace roadstereo::cli

#include "progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "log_stderr.hpp"

namespace roadstereo::cli {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::optional<std::int64_t> total, std::int64_t done, bool quiet)
    : total_(total),
      before_(done),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      shown_(start_) {}

Progress Progress::on_terminal(std::size_t total, bool quiet) {
  return {static_cast<std::int64_t>(total), 0, quiet || ::isatty(STDERR_FILENO) == 0};
}

Progress::~Progress() {
  end();
}

void Progress::end() {
  if (drawn_) log_stderr("\n");
  drawn_ = false;
}

double Progress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

double Progress::frames_per_second() const {
  const double elapsed = seconds();
  return elapsed > 0 ? static_cast<double>(done_) / elapsed : 0;
}

void Progress::frame_done(bool good) {
  ++done_;
  if (!good) ++bad_;
  if (quiet_) return;
  constexpr std::chrono::milliseconds redraw{100};
  constexpr std::chrono::seconds next_line{5};
  const bool last = total_ && before_ + done_ == *total_;
  if (!last && Clock::now() - shown_ < (terminal_ ? redraw : next_line)) return;
  shown_ = Clock::now();
  show();
}

void Progress::show() {
  if (terminal_) {
    log_stderr("\r{} {}\033[K", bar(), line());
    std::fflush(stderr);
    drawn_ = true;
  } else {
    log_stderr("{}\n", line());
  }
}

std::string Progress::bar() const {
  constexpr std::int64_t width = 24;
  if (!total_ || *total_ <= 0) return "";
  const auto filled = static_cast<std::size_t>(std::clamp<std::int64_t>(width * (before_ + done_) / *total_, 0, width));
  return "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(width) - filled, '.') + "]";
}

std::string Progress::line() const {
  const double rate = frames_per_second();
  std::string text = fmt::format("{}", before_ + done_);
  if (total_) text += fmt::format(" of {}", std::max(*total_, before_ + done_));
  text += fmt::format(" frames, {:.1f} frames/s", rate);
  if (total_ && rate > 0) {
    const auto left = std::llround(static_cast<double>(*total_ - before_ - done_) / rate);
    text += fmt::format(", {}:{:02} left", std::max<std::int64_t>(left, 0) / 60, std::max<std::int64_t>(left, 0) % 60);
  }
  if (bad_ > 0) text += fmt::format(", {} without a result", bad_);
  return text;
}

}  // namespace roadstereo::cli

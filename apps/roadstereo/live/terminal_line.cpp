#include "live/terminal_line.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "core/degrees.hpp"
#include "log_stderr.hpp"

namespace roadstereo::cli {
namespace {

constexpr double terminal_period_s = 0.25;
constexpr double plain_period_s = 5;

std::string road_text(const LiveView& view) {
  if (!view.geometry) return ", no road";
  std::string text = ", roll not observable";
  if (view.geometry->roll_observable) {
    text = fmt::format(", roll {:.2f}°", to_degrees(view.geometry->roll_rad));
  }
  if (view.plane) text += fmt::format(", {:.2f} m", view.plane->height_m);
  return text;
}

/// Truncates UTF-8 text to that many columns, because a wrapped line cannot be rewritten.
std::string cut_to(const std::string& text, int columns) {
  int seen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_letter = (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
    if (begins_letter && ++seen > columns) return text.substr(0, i);
  }
  return text;
}

int terminal_columns() {
  winsize size{};
  constexpr int usual = 80;
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (known ? size.ws_col : usual) - 1;
}

std::string message_of(const LiveStatus& status) {
  if (status.message.empty() || status.recording.message.empty()) return status.message + status.recording.message;
  return status.message + "; " + status.recording.message;
}

}  // namespace

std::string status_line(const LiveStatus& status) {
  const LiveCounts& counts = status.counts;
  std::string line = name_of(status.state);
  if (!status.view) return line + fmt::format(" for {:.1f} s", status.age_s);
  line += fmt::format(" {:.1f} fps, latency {:.0f}/{:.0f} ms, age {:.0f} ms", status.fps, status.latency.median_ms,
                      status.latency.p95_ms, 1000 * status.age_s);
  line += road_text(*status.view);
  line += fmt::format(", damages {}/{}, dropped {}", status.view->damages.size(), status.damages_found,
                      counts.dropped + counts.too_old);
  if (counts.rejected > 0) line += fmt::format(", rejected {}", counts.rejected);
  if (status.recording.on) {
    line += fmt::format(", recorded {}", status.recording.recorded);
    if (status.recording.skipped > 0) line += fmt::format(" ({} skipped)", status.recording.skipped);
  }
  return line;
}

TerminalLine::TerminalLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

TerminalLine::~TerminalLine() {
  if (written_) std::fputc('\n', stderr);
}

void TerminalLine::show(const LiveStatus& status) {
  const Clock::time_point now = Clock::now();
  if (std::string message = message_of(status); message != message_) {
    message_ = std::move(message);
    if (!message_.empty()) log_stderr("{}{}\n", written_ ? "\r\033[K" : "", message_);
    due_ = now;
  }
  if (now < due_) return;
  due_ = now + clock_span(terminal_ ? terminal_period_s : plain_period_s);
  if (terminal_) {
    log_stderr("\r\033[K{}", cut_to(status_line(status), terminal_columns()));
    std::fflush(stderr);
    written_ = true;
  } else {
    log_stderr("{}\n", status_line(status));
  }
}

}  // namespace roadstereo::cli

#include "live/capture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

double calendar_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Capture::Capture(std::unique_ptr<io::FrameSource> first, SourceOpener opener, const CaptureOptions& options,
                 LiveBoard& board, LatestValue<CapturedPair>& slot, Recorder* recorder)
    : source_(std::move(first)),
      opener_(std::move(opener)),
      options_(options),
      board_(board),
      slot_(slot),
      recorder_(recorder),
      live_(source_->live()),
      playback_(options.rate_hz) {}

void Capture::sleep_until(Clock::time_point time, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  stopped_.wait_until(lock, stop, time, [] { return false; });
}

void Capture::lose(const std::string& reason) {
  source_.reset();  // a device can be opened only once
  board_.lose_camera(reason);
}

void Capture::reconnect(const std::stop_token& stop) {
  sleep_until(Clock::now() + clock_span(options_.pause.next()), stop);
  if (stop.stop_requested()) return;
  try {
    source_ = opener_();
  } catch (const Error& error) {
    board_.lose_camera(error.what());
  }
}

std::optional<io::SourcePair> Capture::next_of_camera() {
  try {
    std::optional<io::SourcePair> pair = source_->next();
    if (!pair) lose("the camera does not deliver images any more");
    return pair;
  } catch (const Error& error) {
    lose(error.what());
  }
  return std::nullopt;
}

/// Skips overdue pairs without decoding them, except the last one.
void Capture::skip_overdue() {
  std::int64_t overdue = playback_.overdue(Clock::now());
  if (const std::optional<std::int64_t> size = source_->size()) overdue = std::min(overdue, *size - next_index_ - 1);
  if (overdue > 0) source_->skip(overdue);
}

void Capture::count_skipped(const io::SourcePair& pair) {
  if (pair.index > next_index_) {
    board_.count_taken(pair.index - next_index_);
    board_.count_dropped(pair.index - next_index_);
  }
  next_index_ = pair.index + 1;
}

std::optional<io::SourcePair> Capture::next_of_recording(const std::stop_token& stop) {
  skip_overdue();
  std::optional<io::SourcePair> pair = source_->next();
  if (pair) {
    count_skipped(*pair);
    sleep_until(playback_.due(*pair, Clock::now()), stop);
    return pair;
  }
  if (options_.loop && next_index_ == 0) fail("the recording has no pair to repeat");
  ended_ = !options_.loop;
  if (options_.loop) {
    source_ = opener_();
    playback_.begin_again();
    next_index_ = 0;
  }
  return std::nullopt;
}

void Capture::deliver(io::SourcePair pair) {
  board_.count_taken();
  if (!pair.error.empty()) {
    board_.count_rejected(pair.error);
    return;
  }
  CapturedPair captured{std::move(pair), Clock::now(), calendar_s()};
  if (recorder_ != nullptr) {
    const double own_s = captured.pair.time_s;
    recorder_->offer(captured.pair, std::isfinite(own_s) && !options_.loop ? own_s : captured.clock_s);
  }
  if (slot_.put(std::move(captured))) board_.count_dropped();
}

void Capture::run(const std::stop_token& stop) {
  bool lost = false;
  while (!stop.stop_requested() && !ended_) {
    if (!source_) {
      lost = true;
      reconnect(stop);
      continue;
    }
    std::optional<io::SourcePair> pair = live_ ? next_of_camera() : next_of_recording(stop);
    if (!pair || stop.stop_requested()) continue;
    if (std::exchange(lost, false)) {  // an image shows that the camera is back
      options_.pause.reset();
      board_.camera_is_back();
    }
    deliver(std::move(*pair));
  }
}

}  // namespace roadstereo::cli

#include "live/recorder.hpp"

#include <exception>
#include <utility>

#include "lower_priority.hpp"

namespace roadstereo::cli {

Recorder::Recorder(Writer writer, LiveBoard& board) : writer_(std::move(writer)), board_(board) {
  state_.on = true;
  board_.set_recording(state_);
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Recorder::offer(const io::SourcePair& pair, double time_s) {
  const std::lock_guard lock(mutex_);
  if (!state_.message.empty() || waiting_.size() >= max_waiting) {
    ++state_.skipped;
    board_.set_recording(state_);
    return;
  }
  waiting_.push_back(std::make_unique<RecordedPair>(RecordedPair{pair.left, pair.right, time_s}));
  changed_.notify_one();
}

std::unique_ptr<RecordedPair> Recorder::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
  if (waiting_.empty()) return nullptr;
  std::unique_ptr<RecordedPair> pair = std::move(waiting_.front());
  waiting_.pop_front();
  return pair;
}

void Recorder::stop_with(const char* message) {
  const std::lock_guard lock(mutex_);
  state_.message = std::string("recording stopped: ") + message;
  state_.skipped += 1 + static_cast<std::int64_t>(waiting_.size());
  waiting_.clear();
  board_.set_recording(state_);
}

void Recorder::run() {
  lower_priority();
  while (const std::unique_ptr<RecordedPair> pair = next()) {
    try {
      writer_(*pair);
    } catch (const std::exception& error) {
      stop_with(error.what());
      continue;
    }
    const std::lock_guard lock(mutex_);
    ++state_.recorded;
    board_.set_recording(state_);
  }
}

}  // namespace roadstereo::cli

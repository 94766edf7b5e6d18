#include "live/live_board.hpp"

#include <algorithm>
#include <utility>

namespace roadstereo::cli {
namespace {

/// Number of views kept.
constexpr std::size_t kept_views = 3;

}  // namespace

const char* name_of(LiveState state) {
  switch (state) {
    case LiveState::starting:
      return "starting";
    case LiveState::live:
      return "live";
    case LiveState::stale:
      return "stale";
    case LiveState::reconnecting:
      return "reconnecting";
    case LiveState::ended:
      break;
  }
  return "ended";
}

void LiveBoard::count_taken(std::int64_t pairs) {
  const std::lock_guard lock(mutex_);
  counts_.taken += pairs;
}

void LiveBoard::count_dropped(std::int64_t pairs) {
  const std::lock_guard lock(mutex_);
  counts_.dropped += pairs;
}

void LiveBoard::count_too_old() {
  const std::lock_guard lock(mutex_);
  ++counts_.too_old;
}

void LiveBoard::count_rejected(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++counts_.rejected;
  health_.add_without_result();
  if (!lost_ && !ended_) message_ = "the last pair was rejected: " + reason;
}

void LiveBoard::lose_camera(const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    lost_ = true;
    message_ = reason;
  }
  news_.notify_all();
}

void LiveBoard::camera_is_back() {
  {
    const std::lock_guard lock(mutex_);
    lost_ = false;
    ++counts_.reconnects;
    message_.clear();
  }
  news_.notify_all();
}

void LiveBoard::set_static_mask(const io::StaticMaskRecord& mask) {
  const std::lock_guard lock(mutex_);
  static_mask_ = mask;
}

void LiveBoard::set_recording(const RecordingState& recording) {
  const std::lock_guard lock(mutex_);
  recording_ = recording;
}

void LiveBoard::set_path(SharedPath path) {
  const std::lock_guard lock(mutex_);
  path_.swap(path);  // the last one is freed without the lock
}

void LiveBoard::publish(LiveView view) {
  SharedView removed;  // freed without the lock
  {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    view.number = ++counts_.shown;
    view.latency_ms = 1000 * seconds_between(view.arrival, now);
    latency_.add(view.latency_ms);
    rate_.add(now);
    health_.add(view.health);
    list_.add(view);
    if (!lost_ && !ended_) message_.clear();
    views_.push_front(std::make_shared<const LiveView>(std::move(view)));
    if (views_.size() > kept_views) {
      removed = std::move(views_.back());
      views_.pop_back();
    }
  }
  news_.notify_all();
}

void LiveBoard::end(const std::string& message) {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    message_ = message;
  }
  news_.notify_all();
}

LiveState LiveBoard::state(Clock::time_point now) const {
  if (ended_) return LiveState::ended;
  if (lost_) return LiveState::reconnecting;
  if (views_.empty()) return LiveState::starting;
  return seconds_between(views_.front()->arrival, now) > max_age_s_ ? LiveState::stale : LiveState::live;
}

LiveStatus LiveBoard::status_now(std::int64_t after, Clock::time_point now) {
  LiveStatus status;
  status.state = state(now);
  status.message = message_;
  if (!views_.empty()) status.view = views_.front();
  status.age_s = seconds_between(views_.empty() ? start_ : views_.front()->arrival, now);
  status.fps = rate_.per_second(now);
  status.latency = latency_.recent();
  status.counts = counts_;
  status.recording = recording_;
  status.static_mask = static_mask_;
  status.path = path_;
  status.health = health_;
  status.damages_found = list_.found();
  std::copy_if(list_.entries().begin(), list_.entries().end(), std::back_inserter(status.damages),
               [after](const ListedDamage& listed) { return listed.changed_in > after; });
  return status;
}

LiveStatus LiveBoard::status(std::int64_t after) {
  const std::lock_guard lock(mutex_);
  return status_now(after, Clock::now());
}

LiveStatus LiveBoard::wait_for_news(std::int64_t after, double max_s) {
  std::unique_lock lock(mutex_);
  const LiveState before = state(Clock::now());
  news_.wait_until(lock, Clock::now() + clock_span(max_s),
                   [&] { return ended_ || counts_.shown > after || state(Clock::now()) != before; });
  return status_now(after, Clock::now());
}

SharedView LiveBoard::view(std::int64_t number) const {
  const std::lock_guard lock(mutex_);
  if (views_.empty()) return nullptr;
  const auto wanted =
      std::find_if(views_.begin(), views_.end(), [number](const SharedView& one) { return one->number == number; });
  return wanted == views_.end() ? views_.front() : *wanted;
}

LatencyStatistics LiveBoard::latency_of_all() const {
  const std::lock_guard lock(mutex_);
  return latency_.all();
}

}  // namespace roadstereo::cli

#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "live/clock.hpp"
#include "live/damage_list.hpp"
#include "live/latency_log.hpp"
#include "live/live_view.hpp"
#include "live/rate_meter.hpp"

namespace roadstereo::cli {

enum class LiveState {
  starting,      ///< nothing was shown yet
  live,          ///< what is shown is younger than the limit
  stale,         ///< it is older
  reconnecting,  ///< the camera is lost
  ended
};
const char* name_of(LiveState state);

/// What became of the pairs that came due. Once all is done, taken = shown + dropped + too_old + refused.
struct LiveCounts {
  std::int64_t taken = 0;       ///< pairs that came due
  std::int64_t shown = 0;       ///< processed to the end
  std::int64_t dropped = 0;     ///< came while the program was busy
  std::int64_t too_old = 0;     ///< waited longer than the limit
  std::int64_t refused = 0;     ///< could not be processed
  std::int64_t reconnects = 0;  ///< times that a lost camera came back
};

/// What a recording of the raw pairs has come to.
struct RecordingState {
  bool on = false;
  std::int64_t recorded = 0;
  std::int64_t left_out = 0;  ///< pairs it could not keep up with
  std::string message;        ///< why it stopped; empty while it goes on
};

/// How things stand at one moment.
struct LiveStatus {
  LiveState state = LiveState::starting;
  std::string message;  ///< about the state: why the camera is lost, why the last pair was refused
  SharedView view;      ///< the newest; none at the beginning
  double age_s = 0;     ///< of that view, since its pair arrived; without one, since the start
  double fps = 0;
  LatencyFigures latency;  ///< of the last frames
  LiveCounts counts;
  RecordingState recording;
  std::int64_t damages_found = 0;     ///< of the whole run
  std::vector<ListedDamage> damages;  ///< newest first: those changed after the view that was asked for
};

/// Where the threads of a run meet: what is counted, what is shown, and who waits for it. For any number of threads.
class LiveBoard {
 public:
  explicit LiveBoard(double max_age_s) : max_age_s_(max_age_s) {}

  double max_age_s() const { return max_age_s_; }

  void count_taken(std::int64_t pairs = 1);
  void count_dropped(std::int64_t pairs = 1);
  void count_too_old();
  void refuse(const std::string& reason);

  void lose_camera(const std::string& reason);
  void camera_is_back();

  void set_recording(const RecordingState& recording);

  /// Numbers the view, measures its latency and shows it.
  void publish(LiveView view);

  /// Nothing more comes.
  void end(const std::string& message = "");

  /// How things stand. `after`: the number of the view from which on damages have changed.
  LiveStatus status(std::int64_t after = 0);

  /// The same once there is a newer view than that, or the state has changed since the call, or time is up.
  LiveStatus wait_for_news(std::int64_t after, double max_s);

  /// The view of that number, or the newest where that is gone; none at the beginning.
  SharedView view(std::int64_t number) const;

  LatencyFigures latency_of_all() const;

 private:
  LiveState state(Clock::time_point now) const;
  LiveStatus status_now(std::int64_t after, Clock::time_point now);

  const double max_age_s_;
  const Clock::time_point start_ = Clock::now();
  mutable std::mutex mutex_;
  std::condition_variable news_;
  LiveCounts counts_;
  RecordingState recording_;
  bool lost_ = false;
  bool ended_ = false;
  std::string message_;
  std::deque<SharedView> views_;  ///< newest first
  RateMeter rate_;
  LatencyLog latency_;
  DamageList list_;
};

}  // namespace roadstereo::cli

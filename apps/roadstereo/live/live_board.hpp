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
#include "live/live_path.hpp"
#include "live/live_view.hpp"
#include "live/rate_meter.hpp"
#include "live/recent_health.hpp"
#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::cli {

enum class LiveState {
  starting,      ///< no view yet
  live,          ///< the view is younger than the limit
  stale,         ///< the view is older
  reconnecting,  ///< the camera is lost
  ended
};
const char* name_of(LiveState state);

/// Counts of pairs. At the end taken = shown + dropped + too_old + rejected.
struct LiveCounts {
  std::int64_t taken = 0;       ///< read from the source, or due
  std::int64_t shown = 0;       ///< processed
  std::int64_t dropped = 0;     ///< arrived while another pair was processed
  std::int64_t too_old = 0;     ///< older than the limit
  std::int64_t rejected = 0;    ///< could not be processed
  std::int64_t reconnects = 0;  ///< number of times a camera was reconnected
};

/// State of the recording of raw pairs.
struct RecordingState {
  bool on = false;
  std::int64_t recorded = 0;
  std::int64_t skipped = 0;  ///< pairs skipped because the disk was too slow
  std::string message;       ///< why it stopped; empty while running
};

/// Snapshot of a run.
struct LiveStatus {
  LiveState state = LiveState::starting;
  std::string message;  ///< why the camera is lost or the last pair was rejected
  SharedView view;      ///< the newest; null at the start
  double age_s = 0;     ///< since the pair of `view` arrived; without a view, since the start
  double fps = 0;
  LatencyStatistics latency;  ///< of the last frames
  LiveCounts counts;
  RecordingState recording;
  RecentHealth health;                ///< of the last pairs
  SharedPath path;                    ///< with --trajectory; null before the first frame that has a place
  std::int64_t damages_found = 0;     ///< of the whole run
  io::StaticMaskRecord static_mask;   ///< what never moves; frames count those processed
  std::vector<ListedDamage> damages;  ///< newest first: those changed after the given view
};

/// Shared state of a run: counts, views, damages. Notifies waiting threads. Thread-safe.
class LiveBoard {
 public:
  explicit LiveBoard(double max_age_s) : max_age_s_(max_age_s) {}

  double max_age_s() const { return max_age_s_; }

  void count_taken(std::int64_t pairs = 1);
  void count_dropped(std::int64_t pairs = 1);
  void count_too_old();
  void count_rejected(const std::string& reason);

  void lose_camera(const std::string& reason);
  void camera_is_back();

  void set_static_mask(const io::StaticMaskRecord& mask);

  void set_recording(const RecordingState& recording);

  void set_path(SharedPath path);

  /// Numbers the view, measures its latency and publishes it.
  void publish(LiveView view);

  /// Sets the state to ended.
  void end(const std::string& message = "");

  /// Returns a snapshot with the damages changed after the view of number `after`.
  LiveStatus status(std::int64_t after = 0);

  /// The same, after waiting for a newer view, a change of state or the timeout.
  LiveStatus wait_for_news(std::int64_t after, double max_s);

  /// Returns the view of that number, or the newest if it is not kept any more; null at the start.
  SharedView view(std::int64_t number) const;

  LatencyStatistics latency_of_all() const;

 private:
  LiveState state(Clock::time_point now) const;
  LiveStatus status_now(std::int64_t after, Clock::time_point now);

  const double max_age_s_;
  const Clock::time_point start_ = Clock::now();
  mutable std::mutex mutex_;
  std::condition_variable news_;
  LiveCounts counts_;
  RecordingState recording_;
  io::StaticMaskRecord static_mask_;
  SharedPath path_;
  bool lost_ = false;
  bool ended_ = false;
  std::string message_;
  std::deque<SharedView> views_;  ///< newest first
  RateMeter rate_;
  LatencyLog latency_;
  RecentHealth health_;
  DamageList list_;
};

}  // namespace roadstereo::cli

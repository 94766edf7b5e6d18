#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "live/live_view.hpp"

namespace roadstereo::cli {

/// One damage of the list, seen in one or several views.
struct ListedDamage {
  std::int64_t id = 0;          ///< from 1, in the order of the first sighting
  double first_seen_s = 0;      ///< seconds since 1970
  std::int64_t changed_in = 0;  ///< number of the view with the last change
  std::int64_t views = 0;       ///< number of views that show it
  Damage best;                  ///< most precise measurement; not cut by the border if possible
};

/// Tracks the latest damages of a run: damages of successive views are one if they are near their predicted position.
class DamageList {
 public:
  void add(const LiveView& view);

  /// The damages, newest first.
  const std::deque<ListedDamage>& entries() const { return entries_; }

  std::int64_t found() const { return found_; }  ///< number of damages of the whole run

  static constexpr std::size_t max_entries = 100;

 private:
  /// A tracked damage.
  struct Track {
    std::int64_t id = 0;
    Clock::time_point seen{};
    Damage last;                    ///< its last sighting
    std::array<double, 2> speed{};  ///< pixels per second
    bool moved = false;             ///< `speed` is measured
  };

  Track* nearest(const Damage& damage, const LiveView& view, const std::vector<bool>& taken);
  std::array<double, 2> expected(const Track& track, Clock::time_point time) const;
  void follow(Track& track, const Damage& damage, const LiveView& view);
  void begin(const Damage& damage, const LiveView& view);

  std::deque<ListedDamage> entries_;
  std::vector<Track> tracks_;
  std::array<double, 2> common_speed_{};  ///< of the last tracked damage, pixels per second
  std::int64_t found_ = 0;
  std::optional<Clock::time_point> last_view_;
  double interval_s_ = 0;  ///< between the last two views
};

}  // namespace roadstereo::cli

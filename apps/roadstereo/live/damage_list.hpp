#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "live/live_view.hpp"

namespace roadstereo::cli {

/// One damage of the running list, however many pictures show it.
struct ListedDamage {
  std::int64_t id = 0;          ///< from 1, in the order of their appearance
  double first_seen_s = 0;      ///< seconds since 1970
  std::int64_t changed_in = 0;  ///< number of the view that last changed this entry
  std::int64_t views = 0;       ///< that showed it
  Damage best;                  ///< as the view measured it that knows its depth best; uncut before cut
};

/// The latest damages of a run. What two successive views show at about the same place, as far as it was seen to move,
/// is one damage.
class DamageList {
 public:
  void add(const LiveView& view);

  /// Newest first.
  const std::deque<ListedDamage>& entries() const { return entries_; }

  std::int64_t found() const { return found_; }  ///< of the whole run

  static constexpr std::size_t max_entries = 100;

 private:
  /// A damage that is followed from view to view.
  struct Track {
    std::int64_t id = 0;
    DamageKind kind = DamageKind::depression;
    Clock::time_point seen{};
    std::array<double, 2> centre{};  ///< pixels
    std::array<double, 2> speed{};   ///< pixels a second
    bool moved = false;              ///< its speed has been seen
    double reach = 0;                ///< half the diagonal of its box, pixels
  };

  Track* nearest(const Damage& damage, const LiveView& view, const std::vector<bool>& taken);
  std::array<double, 2> expected(const Track& track, Clock::time_point time) const;
  void follow(Track& track, const Damage& damage, const LiveView& view);
  void begin(const Damage& damage, const LiveView& view);

  std::deque<ListedDamage> entries_;
  std::vector<Track> tracks_;
  std::array<double, 2> common_speed_{};  ///< of the last damage that was followed, pixels a second
  std::int64_t found_ = 0;
};

}  // namespace roadstereo::cli

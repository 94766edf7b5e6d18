#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "roadstereo/health.hpp"

namespace roadstereo::cli {

/// What the last pairs of a live run tell of the rig together.
class RecentHealth {
 public:
  static constexpr std::size_t pairs = 200;  ///< that are kept

  void add(const PairHealth& health);
  void add_without_result();

  /// Standard deviation of the rows' offset from frame to frame, pixels; NaN unknown.
  double vibration_px() const;
  /// Share of the pairs that were rejected, 0 … 1; NaN below a hundred pairs.
  double lost_share() const;
  std::vector<HealthFinding> findings() const;

 private:
  struct Pair {
    bool has_result;
    double row_offset_px;  ///< NaN unknown
  };

  void add(const Pair& pair);

  std::deque<Pair> last_;
};

}  // namespace roadstereo::cli

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadstereo::cli {

struct LatencyStatistics {
  double median_ms = 0;
  double p95_ms = 0;
  double max_ms = 0;
};

/// Statistics of the latencies of the last frames and of the whole run, in constant memory.
class LatencyLog {
 public:
  void add(double ms);

  /// Statistics of the last frames, exact.
  LatencyStatistics recent() const;

  /// Statistics of all frames: the maximum is exact, the quantiles are rounded up to 0.25 ms; above 2 s they are the
  /// maximum.
  LatencyStatistics all() const;

 private:
  static constexpr double bin_ms = 0.25;
  static constexpr std::size_t bins = 8000;
  static constexpr std::size_t max_recent = 150;

  double nearest_rank_of_all(double share) const;

  std::vector<double> recent_;  ///< ring buffer
  std::size_t oldest_ = 0;
  std::array<std::uint32_t, bins + 1> counts_{};  ///< the last bin has no upper limit
  std::int64_t total_ = 0;
  double max_ms_ = 0;
};

}  // namespace roadstereo::cli

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roadstereo::cli {

struct LatencyFigures {
  double median_ms = 0;
  double p95_ms = 0;
  double max_ms = 0;
};

/// Latencies of a run of any length in bounded memory: of the last frames, and of all.
class LatencyLog {
 public:
  void add(double ms);

  /// Of the last frames, exact.
  LatencyFigures recent() const;

  /// Of all: the largest is exact, the others to a quarter of a millisecond, from above. Beyond two seconds they are
  /// the largest.
  LatencyFigures all() const;

 private:
  static constexpr double bin_ms = 0.25;
  static constexpr std::size_t bins = 8000;
  static constexpr std::size_t most_recent = 150;

  double quantile_of_all(double share) const;

  std::vector<double> recent_;  ///< a ring
  std::size_t oldest_ = 0;
  std::array<std::uint32_t, bins + 1> counts_{};  ///< the last bin is open
  std::int64_t total_ = 0;
  double max_ms_ = 0;
};

}  // namespace roadstereo::cli

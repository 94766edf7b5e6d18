#include "live/latency_log.hpp"

#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"

namespace roadstereo::cli {

void LatencyLog::add(double ms) {
  if (recent_.size() < max_recent) {
    recent_.push_back(ms);
  } else {
    recent_[oldest_] = ms;
    oldest_ = (oldest_ + 1) % max_recent;
  }
  const double bin = std::ceil(std::max(ms, 0.0) / bin_ms);
  ++counts_[bin > static_cast<double>(bins) ? bins : static_cast<std::size_t>(bin)];
  ++total_;
  max_ms_ = std::max(max_ms_, ms);
}

LatencyStatistics LatencyLog::recent() const {
  if (recent_.empty()) return {};
  std::vector<double> values = recent_;
  return {covering_quantile(values, 0.5), covering_quantile(values, 0.95),
          *std::max_element(values.begin(), values.end())};
}

double LatencyLog::nearest_rank_of_all(double share) const {
  const double rank = std::ceil(share * static_cast<double>(total_));
  double seen = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    seen += counts_[bin];
    if (seen >= rank) return std::min(bin_ms * static_cast<double>(bin), max_ms_);
  }
  return max_ms_;
}

LatencyStatistics LatencyLog::all() const {
  if (total_ == 0) return {};
  return {nearest_rank_of_all(0.5), nearest_rank_of_all(0.95), max_ms_};
}

}  // namespace roadstereo::cli

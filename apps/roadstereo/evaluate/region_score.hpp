#pragma once

#include <cstddef>
#include <limits>

namespace roadstereo::cli {

/// Pixel counts for the comparison of a found region with the true one. Shares are NaN if both are empty.
struct RegionScore {
  std::size_t both = 0;   ///< true positives
  std::size_t found = 0;  ///< pixels of the found region
  std::size_t truth = 0;  ///< pixels of the true region

  void add(bool is_found, bool is_true) {
    found += is_found ? 1U : 0U;
    truth += is_true ? 1U : 0U;
    both += is_found && is_true ? 1U : 0U;
  }
  void add(const RegionScore& other) {
    both += other.both;
    found += other.found;
    truth += other.truth;
  }
  double precision() const { return share(found); }
  double recall() const { return share(truth); }
  /// F-measure: harmonic mean of precision and recall.
  double f() const { return 2 * share(found + truth); }
  /// Intersection over union.
  double iou() const { return share(found + truth - both); }

 private:
  double share(std::size_t total) const {
    if (found + truth == 0) return std::numeric_limits<double>::quiet_NaN();
    return total > 0 ? static_cast<double>(both) / static_cast<double>(total) : 0;
  }
};

}  // namespace roadstereo::cli

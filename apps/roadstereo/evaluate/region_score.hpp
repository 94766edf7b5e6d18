#pragma once

#include <cstddef>
#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// How two regions of pixels agree: what was found and what is true.
struct RegionScore {
  std::size_t both = 0;
  std::size_t found = 0;
  std::size_t truth = 0;

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
  /// Harmonic mean of precision and recall.
  double f() const {
    return found + truth > 0 ? 2.0 * static_cast<double>(both) / static_cast<double>(found + truth) : 0;
  }
  /// Intersection over union.
  double iou() const { return share(found + truth - both); }

 private:
  double share(std::size_t of) const { return of > 0 ? static_cast<double>(both) / static_cast<double>(of) : 0; }
};

}  // namespace roadstereo::cli

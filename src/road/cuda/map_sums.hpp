#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/cuda/solved_map.hpp"

namespace roadstereo::cuda {

/// The ten sums over all disparities of a map and what the solvers that take all of them find from those: one launch,
/// added up in whole numbers of 2⁻¹⁴ px. Coordinates are taken relative to the middle of the map,
/// ((width − 1) / 2, (height − 1) / 2), as on the host.
class MapSums {
 public:
  /// Enqueues it.
  void run(const MaskedMap& map, const RollFromSums& how, StreamView stream);

  const DisparityPlane* plane() const { return &solved_.data()->roll.plane; }  ///< in device memory
  const SolvedMap& solved() const { return *result_.data(); }                  ///< once the stream was synchronised

 private:
  DeviceArray<RawSums> rows_;
  DeviceArray<unsigned> arrived_;
  DeviceArray<SolvedMap> solved_{1};
  PinnedArray<SolvedMap> result_{1};
};

}  // namespace roadstereo::cuda

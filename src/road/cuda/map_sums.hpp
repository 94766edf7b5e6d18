#pragma once

#include <cuda_runtime_api.h>

#include "core/cuda/memory.hpp"
#include "road/cuda/road_fit.hpp"
#include "road/raw_sums.hpp"

namespace roadstereo::cuda {

/// The ten sums over all disparities of a map, for the solvers that take all of them: one launch, added up in a fixed
/// order. Coordinates are taken relative to the middle of the map, ((width − 1) / 2, (height − 1) / 2), as on the host.
class MapSums {
 public:
  /// Enqueues it.
  void run(const MaskedMap& map, cudaStream_t stream);

  /// Once the stream was synchronised.
  const RawSums& sums() const { return *result_.data(); }

 private:
  DeviceArray<RawSums> rows_;
  DeviceArray<unsigned> arrived_;
  PinnedArray<RawSums> result_{1};
};

}  // namespace roadstereo::cuda

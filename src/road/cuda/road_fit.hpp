#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/plane.hpp"
#include "road/cuda/road_fit_statistics.hpp"
#include "road/cuda/robust_plane.hpp"

namespace roadstereo::cuda {

/// A disparity map and the pixels of it that count; a mask without data leaves none out.
struct MaskedMap {
  Plane<const float> disparity;
  Plane<const std::uint8_t> mask;
};

/// The device's part of estimate_roll(), one launch of one block; finish_road_fit() does the rest on the host.
/// The robust solver needs a prior here: without one the host's function searches for a start, and must be called
/// instead. The other solvers take the sums of MapSums, and come back with the plane for `measure`.
class RoadFit {
 public:
  /// Enqueues the robust fit from a prior.
  void run(const MaskedMap& map, const PlaneSource& prior, int max_iterations, cudaStream_t stream);
  /// Enqueues only what tells how well the map fits a plane that is known.
  void measure(const MaskedMap& map, const PlaneTerms& plane, cudaStream_t stream);

  const PlaneTerms* plane() const { return &figures_.data()->plane; }   ///< in device memory
  const RoadFitStatistics& figures() const { return *result_.data(); }  ///< once the stream was synchronised

 private:
  void enqueue(const MaskedMap& map, const PlaneSource& plane, int max_iterations, cudaStream_t stream);

  DeviceArray<float> u_, v_, d_, first_, weights_;
  DeviceArray<RoadFitStatistics> figures_{1};
  PinnedArray<RoadFitStatistics> result_{1};
};

}  // namespace roadstereo::cuda

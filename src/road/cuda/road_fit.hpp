#pragma once

#include <cstdint>

#include "core/cuda/branch.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/cuda/road_fit_statistics.hpp"
#include "road/cuda/robust_plane.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// A disparity map and the pixels of it that count; a mask without data leaves none out.
struct MaskedMap {
  ImageView<const float> disparity;
  ImageView<const std::uint8_t> mask;
};

/// The device's part of estimate_roll(), two launches of one block; finish_road_fit() does the rest on the host. What
/// only the host wants to know runs beside the stream.
/// The robust solver needs a prior here: without one the host's function searches for a start, and must be called
/// instead. The other solvers are those of MapSums, whose plane `measure` takes.
class RoadFit {
 public:
  /// Enqueues the robust fit from a prior.
  void run(const MaskedMap& map, const PlaneSource& prior, int max_iterations, StreamView stream);
  /// Enqueues only what tells how well the map fits a plane that was found elsewhere.
  void measure(const MaskedMap& map, const PlaneSource& plane, StreamView stream);

  /// What `stream` gets from now on waits for the statistics.
  void join(StreamView stream) { branch_.join(stream); }
  /// Waits for them where nobody can be told of an error.
  void settle() const noexcept { branch_.settle(); }

  const DisparityPlane* plane() const { return &statistics_.data()->plane; }  ///< in device memory, after run()
  const RoadFitStatistics& statistics() const { return *result_.data(); }     ///< once joined and synchronised

 private:
  void enqueue(const MaskedMap& map, const PlaneSource& plane, int max_iterations, bool beside, StreamView stream);

  DeviceArray<float> u_, v_, d_, weights_;
  DeviceArray<RoadFitStatistics> statistics_{1};
  PinnedArray<RoadFitStatistics> result_{1};
  Branch branch_;
};

}  // namespace roadstereo::cuda

#pragma once

#include <cuda_runtime_api.h>

#include "core/cuda/memory.hpp"
#include "road/cuda/fitted_plane.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// What DisparityTransform leaves for the host.
struct TransformStatistics {
  double delta_t;
  double sigma_road_px, sigma_all_px, road_share;  ///< RoadResiduals
  int valid;                                       ///< disparities of the map that are not NaN
};

/// Which δt a transformation takes.
struct TransformOffset {
  double given;  ///< RollOptions::delta_t_px; negative derives it
  double least;  ///< of the derived one
};

/// transform_disparity() and measure_residuals() on the device, of a plane that may still lie there: the transformed
/// map equals the host's bit for bit for the same plane. Two launches; the second knows δt from the first.
class DisparityTransform {
 public:
  /// Enqueues it. `transformed` has the size of `disparity`.
  void run(ImageView<const float> disparity, const PlaneSource& road, const TransformOffset& offset,
           ImageView<float> transformed, cudaStream_t stream);

  /// Once the stream was synchronised.
  const TransformStatistics& statistics() const { return *result_.data(); }

  /// What the blocks of the first launch leave for those of the second; begins and ends as zeros but for the last two.
  struct State {
    unsigned arrived;
    unsigned lowest;  ///< key of the lowest height, inverted
    int valid;
    double delta_t, limit;
  };

 private:
  DeviceArray<State> state_;
  DeviceArray<float> sample_;
  DeviceArray<double> sums_;
  PinnedArray<TransformStatistics> result_{1};
};

}  // namespace roadstereo::cuda

#pragma once

#include "core/cuda/digit_counts.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
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
           ImageView<float> transformed, StreamView stream);

  /// Once the stream was synchronised.
  const TransformStatistics& statistics() const { return *result_.data(); }

  /// What the first launch leaves for the second.
  struct Heights {
    double delta_t;
    float limit;  ///< of the residuals that are the road's
    int valid;
  };
  /// What the blocks of a launch add up; begins and ends as zeros.
  struct State {
    Heights found;                        ///< but for this
    int first_digits[DigitCounts::bins];  ///< of the sample's residuals
    unsigned arrived;
    unsigned lowest;  ///< key of the lowest height, inverted
    int valid;
    int unused;  ///< in place of padding
  };

 private:
  DeviceArray<State> state_;
  DeviceArray<float> sample_;
  DeviceArray<double> sums_;
  PinnedArray<TransformStatistics> result_{1};
};

}  // namespace roadstereo::cuda

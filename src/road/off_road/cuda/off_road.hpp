#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/off_road/confirmation.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// reject_off_road (roadstereo/off_road.hpp) on the device. Keeps its memory from frame to frame.
class OffRoad {
 public:
  /// Enqueues the rejection; `max_sigma_px` is above 0.
  void run(const CoarseScene& scene, ImageView<const float> correlation, float max_sigma_px, ImageView<float> disparity,
           ImageView<float> sigma, StreamView stream);

 private:
  DeviceArray<LogSigmas> sigmas_;  ///< of each cell
  DeviceArray<CellState> states_;  ///< of each cell
  DeviceArray<int> doubtful_{1};   ///< whether any cell is unconfirmed or contradicted
};

}  // namespace roadstereo::cuda

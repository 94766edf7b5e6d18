#pragma once

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/off_road/confirmation.hpp"
#include "road/off_road/consistency.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// reject_off_road and reject_inconsistent (roadstereo/off_road.hpp) on the device. Keeps its memory from frame to
/// frame.
class OffRoad {
 public:
  /// Enqueues the rejection; `max_sigma_px` is above 0.
  void run(ImageView<const float> correlation, float max_sigma_px, ImageView<float> disparity, ImageView<float> sigma,
           StreamView stream);
  /// Enqueues the check of consistency with the map of a coarse search, which lies in device memory.
  void run(const CoarseScene& scene, ImageView<float> disparity, ImageView<float> sigma, StreamView stream);

 private:
  DeviceArray<LogSigmas> sigmas_;  ///< of each cell
  DeviceArray<CellState> states_;
  DeviceArray<CellEvidence> evidence_;
};

}  // namespace roadstereo::cuda

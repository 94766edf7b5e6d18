#pragma once

#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "road/cuda/plane_match.hpp"
#include "road/cuda/robust_plane.hpp"
#include "road/cuda/verification_statistics.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// A search's places and what the fit to them needs, in device memory.
struct SearchMemory {
  GuidedSlots slots;
  int count;
  float* weights;
};

/// The device's part of verify_road_model(): two searches around the last frame's plane, each with a robust fit. What
/// the statistics say of the road is assess_road_verification()'s to tell. Four launches, five for large images.
class RoadVerification {
 public:
  /// Enqueues it. The images must stay until then.
  void run(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, const PlaneSource& previous,
           bool with_roll, StreamView stream);

  /// Once the stream was synchronised.
  const VerificationStatistics& statistics() const { return *result_.data(); }

 private:
  /// The places of one search.
  struct Search {
    DeviceArray<float> u, v, d, correlation, weights;
    DeviceArray<int> tried;

    SearchMemory memory(int count);
  };

  GuidedPair downsampled(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, StreamView stream);

  Search around_, close_;
  DeviceArray<std::int16_t> pixels_;
  DeviceArray<SearchStatistics> found_around_{1};
  PinnedArray<VerificationStatistics> result_{1};
};

}  // namespace roadstereo::cuda

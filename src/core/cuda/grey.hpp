#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "core/grey_level.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// A camera frame in device memory. Rows may have any distance; samples lie at multiples of their size.
struct DeviceFrame {
  const void* data = nullptr;
  std::ptrdiff_t stride_bytes = 0;
  int sample_bytes = 1;  ///< 1 or 2
  int channels = 1;      ///< 1, 3 or 4
  GreyWeights weights{};
};

/// Findings of the conversion about a pair.
struct PairFindings {
  int left_varies;   ///< 0: every pixel has the level `left_level`
  int right_varies;  ///< likewise
  int differ;        ///< 0: both images are the same
  int left_level, right_level;
};

/// Both frames of a pair to grey, in one launch.
class PairToGrey {
 public:
  /// `left` and `right` have the same size and receive the levels.
  void convert(const DeviceFrame& left_frame, const DeviceFrame& right_frame, ImageView<std::int16_t> left,
               ImageView<std::int16_t> right, StreamView stream);

  /// Of the last pair, on the host once the stream was waited for.
  const PairFindings& findings() const { return *findings_.data(); }

 private:
  DeviceArray<int> votes_;  ///< what blocks have found, and how many of them have ended; all 0 between two launches
  PinnedArray<PairFindings> findings_;
};

}  // namespace roadstereo::cuda

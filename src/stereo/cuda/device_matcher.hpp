#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/cuda/memory.hpp"
#include "core/cuda/plane.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/cuda/match_view.hpp"

namespace roadstereo::cuda {

/// A MatchInput in device memory.
struct DeviceMatchInput {
  Plane<const std::int16_t> reference, target;
  const int* first_column = nullptr;            ///< per row; null: all columns are valid
  int disparities = 1;                          ///< D
  const TileRange* reference_ranges = nullptr;  ///< null: every pixel searches all D disparities
  const TileRange* target_ranges = nullptr;
  Plane<const float> prior{};  ///< no data: the costs alone decide
  int prior_factor = 1;
};

/// MatchMaps in device memory, rows without padding.
struct DeviceMatchMaps {
  Plane<float> disparity, variance;
  Plane<std::int16_t> winner, target_winner;
};

/// Section 3.2 of the paper on the device. Keeps its memory from frame to frame; only enqueues.
class DeviceMatcher {
 public:
  /// For a device with so many multiprocessors.
  explicit DeviceMatcher(int multiprocessors) : multiprocessors_(multiprocessors) {}

  /// The options must be valid; the maps live until the next call.
  const DeviceMatchMaps& match(const DeviceMatchInput& input, const MatcherOptions& options, cudaStream_t stream);

 private:
  void use(const MatcherOptions& options, cudaStream_t stream);
  void reserve(int width, int height);
  ViewToMatch view_of(const DeviceMatchInput& input, bool mirrored) const;

  int multiprocessors_;
  std::optional<MatcherOptions> options_;  ///< that the taps are made for
  ViewSettings settings_{};
  PinnedArray<WindowTap> taps_;
  DeviceArray<WindowTap> taps_on_device_;
  DeviceArray<ColumnSums> column_sums_[2];
  DeviceArray<BlockPart> blocks_[2];
  DeviceArray<int> first_columns_;
  DeviceArray<float> energies_, disparity_, variance_;
  DeviceArray<std::int16_t> winner_, target_winner_;
  BlockSums sums_{};
  DeviceMatchMaps maps_{};
};

}  // namespace roadstereo::cuda

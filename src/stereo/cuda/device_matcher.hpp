#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/cuda/branch.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/cuda/match_view.hpp"

namespace roadstereo::cuda {

/// MatchMaps in device memory, rows without padding.
struct DeviceMatchMaps {
  ImageView<float> disparity, variance;
  ImageView<std::int16_t> winner, target_winner;
};

/// Section 3.2 of the paper on the device. Keeps its memory from frame to frame; only enqueues.
class DeviceMatcher {
 public:
  /// For a device with so many multiprocessors.
  explicit DeviceMatcher(int multiprocessors) : multiprocessors_(multiprocessors) {}

  /// `input` lies in device memory; the options must be valid. The maps are valid until the next call.
  const DeviceMatchMaps& match(const MatchInput& input, const MatcherOptions& options, StreamView stream);
  /// Waits for what does not run in the caller's stream.
  void settle() const noexcept { target_branch_.settle(); }

 private:
  void make_taps(const MatcherOptions& options, StreamView stream);
  void use(const MatcherOptions& options, StreamView stream);
  void reserve(int width, int height, int columns, int rows);
  ViewToMatch view_of(const MatchInput& input, bool mirrored) const;

  int multiprocessors_;
  std::optional<MatcherOptions> options_;  ///< that the taps are made for
  ViewSettings settings_{};
  PinnedArray<WindowTap> taps_;
  DeviceArray<WindowTap> taps_on_device_;
  DeviceArray<ColumnSums> column_sums_[2];
  DeviceArray<BlockPart> blocks_[2];
  DeviceArray<int> first_columns_;
  DeviceArray<float> energies_, offset_, disparity_, variance_;
  DeviceArray<std::int16_t> winner_, target_winner_;
  BlockSums sums_{};
  DeviceMatchMaps maps_{};
  DeviceArray<unsigned> drawn_;  ///< TileTickets of both views
  unsigned drawn_before_[2] = {};
  Branch target_branch_;
};

}  // namespace roadstereo::cuda

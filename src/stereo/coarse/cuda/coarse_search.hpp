#pragma once

#include <cstddef>
#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/stream.hpp"
#include "roadstereo/coarse_search.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"
#include "stereo/coarse/path_winner.hpp"

namespace roadstereo::cuda {

/// CoarseSearch on the device: NCC block matching on the downsampled pair, scanline optimisation, road plane as prior.
/// Keeps its memory from frame to frame; the results lie in device memory and are valid until the next call.
class CudaCoarseSearch {
 public:
  /// Numbers of one of the three volumes of costs: larger pairs are matched band by band, so that they fit small
  /// devices.
  static constexpr std::ptrdiff_t usual_numbers = std::ptrdiff_t{1} << 25;

  /// The options must be valid.
  explicit CudaCoarseSearch(const CoarseSearchOptions& options, std::ptrdiff_t max_numbers = usual_numbers)
      : options_(options), max_numbers_(max_numbers) {}

  /// Options from now on; they must be valid.
  void set_options(const CoarseSearchOptions& options) { options_ = options; }

  /// Enqueues the search of `input`, which lies in device memory. Returns false, without prior and ranges, when the
  /// image is too small.
  bool find(const MatchInput& input, const PerspectiveShift& shift, StreamView stream);
  /// The same without the ranges and the intervals of the prior.
  bool find_prior(const MatchInput& input, const PerspectiveShift& shift, StreamView stream);

  DisparityPriorView prior() const {
    const auto map = [&](const DeviceArray<float>& of) { return ImageView<const float>(of.data(), width_, height_); };
    if (!intervals_found_) return {map(prior_), factor_};
    return {map(prior_), factor_, map(low_), map(high_)};
  }
  /// Empty when there are too few disparities to save any.
  SearchRangeViews ranges() const { return ranges_; }

 private:
  CoarseVolume reserve(const MatchInput& input);
  CoarsePair downsample_pair(const MatchInput& input, StreamView stream);
  void match_band(const CoarsePair& pair, const PerspectiveShift& shift, const CoarseVolume& shape, int first_row,
                  StreamView stream);
  void find_intervals(const PerspectiveShift& shift, StreamView stream);
  void find_ranges(const MatchInput& input, StreamView stream);

  CoarseSearchOptions options_;
  std::ptrdiff_t max_numbers_;
  int width_ = 0, height_ = 0, factor_ = 1;  ///< of the coarse map
  DeviceArray<std::int16_t> reference_, target_;
  DeviceArray<int> first_seen_;
  DeviceArray<RoadCost> roads_;
  DeviceArray<float> costs_, forward_, backward_;
  DeviceArray<float> along_rows_, prior_, low_, high_;
  DeviceArray<SearchRange> reference_ranges_, target_ranges_;
  SearchRangeViews ranges_;
  bool intervals_found_ = false;
};

}  // namespace roadstereo::cuda

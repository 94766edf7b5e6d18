#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "core/cuda/memory.hpp"
#include "core/cuda/plane.hpp"
#include "road/shift_terms.hpp"
#include "roadstereo/coarse_search.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"
#include "stereo/coarse/tile_range.hpp"

namespace roadstereo::cuda {

/// A pair in device memory, the target already transformed.
struct CoarseInput {
  Plane<const std::int16_t> reference, target;
  const int* first_column = nullptr;  ///< per row, device memory; null: all columns of the target are valid
  int disparities = 1;                ///< of the full size
  ShiftTerms shift;                   ///< its road, where it is enabled, is the guess
};

/// CoarseSearch on the device: fills the prior and, where narrowing pays, the ranges. Holds its memory from frame to
/// frame; what it leaves lies in device memory and is valid until the next call.
class CudaCoarseSearch {
 public:
  /// Numbers of one of the three volumes of costs: larger pairs are matched band by band, so that they fit small
  /// devices.
  static constexpr std::ptrdiff_t usual_numbers = std::ptrdiff_t{1} << 25;

  /// The options must be valid.
  explicit CudaCoarseSearch(const CoarseSearchOptions& options, std::ptrdiff_t max_numbers = usual_numbers)
      : options_(options), max_numbers_(max_numbers) {}

  /// Only enqueues. False, with neither prior nor ranges, when the image is too small.
  bool find(const CoarseInput& input, cudaStream_t stream);

  /// The coarse map, in pixels of the full size: its pixel (x, y) stands for the factor() × factor() pixels from
  /// (x·factor(), y·factor()) on. NaN: nothing is known.
  Plane<const float> prior() const { return packed_plane(prior_.data(), width_, height_); }
  int factor() const { return factor_; }

  /// One range for each tile of SearchRanges, row by row; null when there are too few disparities to save any.
  const TileRange* reference_ranges() const { return ranges_found_ ? reference_ranges_.data() : nullptr; }
  const TileRange* target_ranges() const { return ranges_found_ ? target_ranges_.data() : nullptr; }

 private:
  CoarseVolume reserve(const CoarseInput& input);
  CoarsePair downsample_pair(const CoarseInput& input, cudaStream_t stream);
  void match_band(const CoarsePair& pair, const CoarseInput& input, const CoarseVolume& shape, int first_row,
                  cudaStream_t stream);
  void find_ranges(const CoarseInput& input, cudaStream_t stream);

  CoarseSearchOptions options_;
  std::ptrdiff_t max_numbers_;
  int width_ = 0, height_ = 0, factor_ = 1;  ///< of the coarse map
  DeviceArray<std::int16_t> reference_, target_;
  DeviceArray<int> first_seen_;
  DeviceArray<float> costs_, forth_, back_;
  DeviceArray<float> along_rows_, prior_;
  DeviceArray<TileRange> reference_ranges_, target_ranges_;
  bool ranges_found_ = false;
};

}  // namespace roadstereo::cuda

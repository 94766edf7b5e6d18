#pragma once

#include <array>
#include <vector>

#include "roadstereo/coarse_search.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective_shift.hpp"
#include "stereo/coarse/prior_intervals.hpp"
#include "stereo/coarse/scanline.hpp"
#include "stereo/coarse/texture_uncertainty.hpp"
#include "stereo/coarse/tile_ranges.hpp"
#include "stereo/cpu/padded_rows.hpp"
#include "stereo/cpu/tile_costs.hpp"

namespace roadstereo {

/// Coarse-to-fine prior: NCC block matching on the downsampled pair, scanline optimisation, road plane as prior where
/// texture is weak. Yields disparity ranges per tile and a disparity prior. Keeps its memory from frame to frame.
class CoarseSearch {
 public:
  CoarseSearch(const CoarseSearchOptions& options, int threads);

  /// Options from now on.
  void set_options(const CoarseSearchOptions& options) { options_ = options; }

  /// Computes the prior and, where that saves work, the ranges; both are valid until the next call. `shift`: that of
  /// the target, with the road. Returns false when the image is too small.
  bool find(const MatchInput& input, const PerspectiveShift& shift);
  /// The same without the ranges and the intervals of the prior.
  bool find_prior(const MatchInput& input, const PerspectiveShift& shift);

  const DisparityPrior& prior() const { return prior_; }
  /// Null when there are too few disparities to save any.
  const SearchRanges* ranges() const { return ranges_found_ ? &tile_ranges_.ranges() : nullptr; }

 private:
  /// The road as prior of a row, per column: where it is, coarse pixels, and what a distance from it costs.
  struct RoadOfRow {
    std::vector<float> centre, weight, truncation;
  };
  /// Memory of one thread.
  struct Worker {
    cpu::TileCosts costs;
    TextureUncertainty texture;
    cpu::PaddedRows<float> costs_of_row, scratch;  ///< two rows each
    std::array<RoadOfRow, 2> road;
    std::vector<float> nearest;  ///< disparity that the target view sees, per column
    IntervalScratch interval;
  };
  void downsample_pair(const MatchInput& input, int factor);
  void match_rows(const MatchInput& coarse, int first, int last, const PerspectiveShift& shift, Worker& worker);
  void weigh_road(const ScanlineCosts& row, int v, const PerspectiveShift& shift, const float* texture_uncertainty,
                  RoadOfRow& road) const;
  void correct_rows(int first, int last, Worker& worker);
  void find_intervals(const PerspectiveShift& shift);
  int band_rows() const;

  CoarseSearchOptions options_;
  int threads_;
  GreyImage reference_, target_;
  std::vector<int> first_column_, block_first_column_;
  std::vector<Worker> workers_;
  Image<float> along_rows_;  ///< result of the scanline optimisation, coarse pixels
  DisparityPrior prior_;
  TileRanges tile_ranges_;
  bool ranges_found_ = false;
};

}  // namespace roadstereo

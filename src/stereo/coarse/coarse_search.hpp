#pragma once

#include <vector>

#include "core/function_ref.hpp"
#include "roadstereo/coarse_search.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/coarse/texture_uncertainty.hpp"
#include "stereo/coarse/tile_ranges.hpp"
#include "stereo/cpu/padded_rows.hpp"
#include "stereo/cpu/tile_costs.hpp"

namespace roadstereo {

/// Looks at the shrunk pair before matching: which disparities each tile can have, and a coarse map to lean on. Holds
/// its memory from frame to frame.
class CoarseSearch {
 public:
  CoarseSearch(const CoarseSearchOptions& options, int threads);

  /// Fills the prior and, where narrowing pays, the ranges; both are valid until the next call. `road(u, v)` is the
  /// disparity that the road has at a pixel of the pair, NaN where it is not known. False when the image is too small.
  bool find(const MatchInput& input, FunctionRef<double(double, double)> road);

  const DisparityPrior& prior() const { return prior_; }
  /// Null when there are too few disparities to save any.
  const SearchRanges* ranges() const { return ranges_found_ ? &tile_ranges_.ranges() : nullptr; }

 private:
  /// What one thread needs.
  struct Worker {
    cpu::TileCosts costs;
    TextureUncertainty evidence;
    cpu::PaddedRows<float> row, scratch;
    std::vector<float> centre, pull;  ///< of the road, per column
    std::vector<float> nearest;       ///< disparity that the target view sees, per column
  };
  void downsample_pair(const MatchInput& input, int factor);
  void match_rows(const MatchInput& coarse, int first, int last, FunctionRef<double(double, double)> road,
                  Worker& worker);
  void finish_row(const MatchInput& coarse, int v, FunctionRef<double(double, double)> road, Worker& worker);
  void correct_rows(int first, int last, Worker& worker);

  CoarseSearchOptions options_;
  int threads_;
  GreyImage reference_, target_;
  std::vector<int> first_column_, block_first_column_;
  std::vector<Worker> workers_;
  Image<float> along_rows_;  ///< what the paths along the rows found, coarse pixels
  DisparityPrior prior_;
  TileRanges tile_ranges_;
  bool ranges_found_ = false;
};

}  // namespace roadstereo

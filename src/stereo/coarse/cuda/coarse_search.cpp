#include "stereo/coarse/cuda/coarse_search.hpp"

#include <algorithm>

#include "core/cuda/downsample.hpp"
#include "roadstereo/matcher.hpp"
#include "stereo/coarse/coarse_size.hpp"
#include "stereo/coarse/cuda/block_costs.hpp"
#include "stereo/coarse/cuda/coarse_map.hpp"
#include "stereo/coarse/cuda/paths.hpp"
#include "stereo/coarse/cuda/prior_interval.hpp"
#include "stereo/coarse/cuda/road_prior.hpp"
#include "stereo/coarse/cuda/tile_ranges.hpp"
#include "stereo/coarse/texture_uncertainty.hpp"

namespace roadstereo::cuda {
namespace {

std::size_t area(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

CoarseTiles tiles_of_pair(int width, int height, int factor) {
  const auto tiles_along = [](int pixels, int tile) { return (pixels + tile - 1) / tile; };
  return {tiles_along(width, SearchRanges::tile_columns), tiles_along(height, SearchRanges::tile_rows),
          SearchRanges::tile_columns / factor, SearchRanges::tile_rows / factor};
}

RoadPrior road_prior(const CoarseSearchOptions& options, const PerspectiveShift& shift, int factor) {
  return {shift, HeightPrior(options.road_prior_height_m, options.road_prior_truncation, shift, factor),
          uncertainty_params(texture_uncertainty_options(options)), options.block_radius};
}

}  // namespace

bool CudaCoarseSearch::find(const MatchInput& input, const PerspectiveShift& shift, StreamView stream) {
  if (!find_prior(input, shift, stream)) return false;
  if (options_.border_height_m > 0) find_intervals(shift, stream);
  if (input.disparities >= min_ranged_disparities) find_ranges(input, stream);
  return true;
}

bool CudaCoarseSearch::find_prior(const MatchInput& input, const PerspectiveShift& shift, StreamView stream) {
  ranges_ = {};
  intervals_found_ = false;
  width_ = height_ = 0;
  const int width = input.reference.width(), height = input.reference.height();
  if (!coarse_search_pays(width, height)) return false;
  factor_ = coarse_factor(options_, width, input.disparities);
  width_ = width / factor_;
  height_ = height / factor_;
  const CoarseVolume shape = reserve(input);
  const CoarsePair pair = downsample_pair(input, stream);
  for (int row = 0; row < height_; row += shape.rows) match_band(pair, shift, shape, row, stream);
  correct_rows(ImageView<const float>(along_rows_.data(), width_, height_), factor_,
               ImageView(prior_.data(), width_, height_), stream);
  return true;
}

/// Makes room for everything, and says how many rows are matched at a time.
CoarseVolume CudaCoarseSearch::reserve(const MatchInput& input) {
  const std::size_t pixels = area(width_, height_);
  for (DeviceArray<std::int16_t>* image : {&reference_, &target_}) image->reserve(pixels);
  for (DeviceArray<float>* map : {&along_rows_, &prior_}) map->reserve(pixels);
  roads_.reserve(pixels);
  first_seen_.reserve(static_cast<std::size_t>(height_));
  const CoarseTiles tiles = tiles_of_pair(input.reference.width(), input.reference.height(), factor_);
  for (DeviceArray<SearchRange>* ranges : {&reference_ranges_, &target_ranges_}) {
    ranges->reserve(area(tiles.across, tiles.down));
  }
  const int disparities = coarse_disparities(input.disparities, factor_);
  CoarseVolume shape{nullptr, width_, disparities, path_pitch(disparities), 0, 0};
  const std::ptrdiff_t of_row = std::ptrdiff_t{shape.columns} * shape.pitch;
  shape.rows = static_cast<int>(std::clamp<std::ptrdiff_t>(max_numbers_ / of_row, 1, height_));
  for (DeviceArray<float>* volume : {&costs_, &forward_, &backward_}) {
    volume->reserve(static_cast<std::size_t>(of_row * shape.rows));
  }
  return shape;
}

CoarsePair CudaCoarseSearch::downsample_pair(const MatchInput& input, StreamView stream) {
  const auto reference = ImageView(reference_.data(), width_, height_);
  const auto target = ImageView(target_.data(), width_, height_);
  downsample(input.reference, input.target, factor_, reference, target, stream);
  return {reference, target, input.first_column, factor_};
}

/// Optimises the scanlines of a band of rows, with the road as prior where texture is weak.
void CudaCoarseSearch::match_band(const CoarsePair& pair, const PerspectiveShift& shift, const CoarseVolume& shape,
                                  int first_row, StreamView stream) {
  CoarseVolume costs = shape;
  costs.first_row = first_row;
  costs.rows = std::min(shape.rows, height_ - first_row);
  CoarseVolume forward = costs, backward = costs;
  costs.numbers = costs_.data();
  forward.numbers = forward_.data();
  backward.numbers = backward_.data();
  const double noise = options_.ncc_noise_sigma * grey_scale;
  const ImageView roads(roads_.data(), width_, height_);
  block_costs(pair, static_cast<float>(noise * noise), road_prior(options_, shift, factor_), costs, roads,
              first_seen_.data(), stream);
  aggregate_scanlines(costs, {static_cast<float>(options_.step_penalty), static_cast<float>(options_.jump_penalty)},
                      roads, first_seen_.data(), forward, backward, ImageView(along_rows_.data(), width_, height_),
                      stream);
}

/// The matcher's freedom where the map changes.
void CudaCoarseSearch::find_intervals(const PerspectiveShift& shift, StreamView stream) {
  for (DeviceArray<float>* map : {&low_, &high_}) map->reserve(area(width_, height_));
  find_prior_intervals(prior().disparity, factor_,
                       {shift, PixelHeight(shift, options_.border_height_m, 1), options_.block_radius},
                       ImageView(low_.data(), width_, height_), ImageView(high_.data(), width_, height_), stream);
  intervals_found_ = true;
}

void CudaCoarseSearch::find_ranges(const MatchInput& input, StreamView stream) {
  const CoarseTiles tiles = tiles_of_pair(input.reference.width(), input.reference.height(), factor_);
  find_tile_ranges(prior().disparity, factor_, input.disparities, tiles, reference_ranges_.data(),
                   target_ranges_.data(), stream);
  ranges_ = {ImageView<const SearchRange>(reference_ranges_.data(), tiles.across, tiles.down),
             ImageView<const SearchRange>(target_ranges_.data(), tiles.across, tiles.down)};
}

}  // namespace roadstereo::cuda

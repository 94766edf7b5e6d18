#include "stereo/coarse/coarse_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/downsample.hpp"
#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "roadstereo/error.hpp"
#include "stereo/coarse/coarse_column.hpp"
#include "stereo/coarse/coarse_map.hpp"
#include "stereo/coarse/coarse_road.hpp"
#include "stereo/coarse/coarse_size.hpp"
#include "stereo/coarse/height_prior.hpp"
#include "stereo/coarse/road_plausibility.hpp"
#include "stereo/coarse/road_weights.hpp"
#include "stereo/coarse/scanline.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace {

constexpr int min_rows = 24;  // of a band
constexpr int max_block_radius = 10;

}  // namespace

void CoarseSearchOptions::validate() const {
  if (factor != 0 && factor != 2 && factor != 4 && factor != 8) {
    fail("coarse_search.factor is ", factor, "; it must be 2, 4 or 8, or 0 to derive it");
  }
  require_range("coarse_search", "block_radius", block_radius, 1, max_block_radius);
  require_range("coarse_search", "ncc_noise_sigma", ncc_noise_sigma, 0.0, 50.0);
  require_range("coarse_search", "step_penalty", step_penalty, 0.0, 10.0);
  require_range("coarse_search", "jump_penalty", jump_penalty, 0.0, 10.0);
  require_range("coarse_search", "road_prior_height_m", road_prior_height_m, 0.0, 100.0);
  require_range("coarse_search", "road_prior_truncation", road_prior_truncation, 0.0, 100.0);
  require_range("coarse_search", "border_height_m", border_height_m, 0.0, 100.0);
  require_range("coarse_search", "row_offset_sigma_px", row_offset_sigma_px, 0.0, 10.0);
  require_range("coarse_search", "half_weight_sigma_px", half_weight_sigma_px, 0.01, 10.0);
}

CoarseSearch::CoarseSearch(const CoarseSearchOptions& options, int threads)
    : options_(options), threads_(resolve_threads(threads)), workers_(static_cast<std::size_t>(threads_)) {
  options.validate();
}

void CoarseSearch::downsample_pair(const MatchInput& input, int factor) {
  for (GreyImage* small : {&reference_, &target_}) {
    small->resize(input.reference.width() / factor, input.reference.height() / factor);
  }
  parallel_for(2, threads_, [&](int side, int) {
    downsample(side == 0 ? input.reference : input.target, factor, (side == 0 ? reference_ : target_).view());
  });
  first_column_.assign(static_cast<std::size_t>(reference_.height()), 0);
  if (input.first_column == nullptr) return;
  for (std::size_t v = 0; v < first_column_.size(); ++v) {
    const int* rows = input.first_column + static_cast<std::size_t>(factor) * v;
    const int first = *std::max_element(rows, rows + factor);
    first_column_[v] = coarse_column(first, factor, reference_.width());
  }
}

bool CoarseSearch::find(const MatchInput& input, const PerspectiveShift& shift) {
  if (!find_prior(input, shift)) return false;
  find_intervals(shift);
  if (input.disparities < min_ranged_disparities) return true;
  tile_ranges_.find(prior_.disparity, prior_.factor, input.reference.width(), input.reference.height(),
                    input.disparities, threads_);
  ranges_found_ = true;
  return true;
}

bool CoarseSearch::find_prior(const MatchInput& input, const PerspectiveShift& shift) {
  const int width = input.reference.width(), height = input.reference.height();
  ranges_found_ = false;
  for (Image<float>* map : {&prior_.low, &prior_.high}) map->resize(0, 0);
  if (!coarse_search_pays(width, height)) return false;
  prior_.factor = coarse_factor(options_, width, input.disparities);
  downsample_pair(input, prior_.factor);
  const int disparities = coarse_disparities(input.disparities, prior_.factor);
  const MatchInput coarse{reference_, target_, first_column_.data(), disparities};
  block_first_columns(coarse, options_.block_radius, block_first_column_);
  for (Image<float>* map : {&along_rows_, &prior_.disparity}) map->resize(reference_.width(), reference_.height());

  MatcherOptions block;
  block.pixel_step = 1;
  block.block_radius = options_.block_radius;
  block.block_aspect = 1;
  block.ncc_noise_sigma = options_.ncc_noise_sigma;
  for (Worker& worker : workers_) {
    worker.costs.prepare(reference_.width(), coarse.disparities, block);
    worker.texture.prepare(reference_.width());
    const std::ptrdiff_t pitch = cpu::padded_disparities(coarse.disparities);
    worker.costs_of_row.resize(2, 0, reference_.width() * pitch);
    worker.scratch.resize(2, 0, static_cast<std::ptrdiff_t>(scanline_scratch(reference_.width(), pitch)));
    for (std::size_t k = 0; k < 2; ++k) {
      RoadOfRow& road = worker.road[k];
      for (std::vector<float>* per_column : {&road.centre, &road.weight, &road.truncation}) {
        per_column->resize(static_cast<std::size_t>(reference_.width()));
      }
      guard_scanline_scratch(reference_.width(), pitch, coarse.disparities, worker.scratch.row(k));
    }
    worker.nearest.reserve(static_cast<std::size_t>(reference_.width()));
    worker.interval.reserve(reference_.width(), max_block_radius);
  }
  parallel_rows(reference_.height(), band_rows(), threads_, [&](int first, int last, int worker) {
    match_rows(coarse, first, last, shift, workers_[static_cast<std::size_t>(worker)]);
  });
  parallel_rows(reference_.height(), band_rows(), threads_, [&](int first, int last, int worker) {
    correct_rows(first, last, workers_[static_cast<std::size_t>(worker)]);
  });
  return true;
}

/// A band begins by filling its sums, so it should be high.
int CoarseSearch::band_rows() const {
  return std::max(min_rows, (reference_.height() + 4 * threads_ - 1) / (4 * threads_));
}

/// The matcher's freedom where the map changes.
void CoarseSearch::find_intervals(const PerspectiveShift& shift) {
  if (options_.border_height_m == 0) return;
  const int width = prior_.disparity.width(), height = prior_.disparity.height();
  for (Image<float>* map : {&prior_.low, &prior_.high}) map->resize(width, height);
  const PixelHeight heights(shift, options_.border_height_m, 1);
  parallel_rows(height, band_rows(), threads_, [&](int first, int last, int worker) {
    find_prior_intervals(shift, heights, options_.block_radius, first, last,
                         workers_[static_cast<std::size_t>(worker)].interval, prior_);
  });
}

void CoarseSearch::match_rows(const MatchInput& coarse, int first, int last, const PerspectiveShift& shift,
                              Worker& worker) {
  const cpu::MatchView view(coarse, cpu::MatchView::reference, block_first_column_);
  worker.costs.start(view, first, 0, view.width(), {0, coarse.disparities});
  const bool road_is_prior = options_.road_prior_height_m > 0;
  if (road_is_prior) worker.texture.start(coarse.reference, first, texture_uncertainty_options(options_));
  const ScanlinePenalties penalties{static_cast<float>(options_.step_penalty),
                                    static_cast<float>(options_.jump_penalty)};
  for (int v = first; v < last; v += 2) {
    std::array<Scanline, 2> rows;
    const int count = std::min(2, last - v);
    for (int k = 0; k < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      float* const costs = worker.costs_of_row.row(at);
      RoadOfRow& road = worker.road[at];
      worker.costs.compute(v + k, costs);
      rows[at] = {{costs, worker.costs.pitch(), reference_.width(), coarse.disparities,
                   block_first_column_[static_cast<std::size_t>(v) + at]},
                  {road.centre.data(), road.weight.data(), road.truncation.data()},
                  worker.scratch.row(at),
                  along_rows_.row(v + k)};
      weigh_road(rows[at].costs, v + k, shift, road_is_prior ? worker.texture.next().data() : nullptr, road);
    }
    optimise_scanlines(rows.data(), count, penalties, uncorrelated_cost);
  }
}

/// The road as prior of row v where texture is weak; without `texture_uncertainty` it has no weight.
void CoarseSearch::weigh_road(const ScanlineCosts& row, int v, const PerspectiveShift& shift,
                              const float* texture_uncertainty, RoadOfRow& road) const {
  const HeightPrior heights(options_.road_prior_height_m, options_.road_prior_truncation, shift, prior_.factor);
  const CoarseRoad plane(shift, v, prior_.factor);
  float *const centre = road.centre.data(), *const weight = road.weight.data(),
               *const truncation = road.truncation.data();
  for (int u = 0; u < row.columns; ++u) {
    const float disparity = plane.disparity(u);
    centre[u] = plane.shifted(disparity);
    const DistanceCost cost =
        texture_uncertainty == nullptr ? DistanceCost{} : heights.at(disparity, texture_uncertainty[u]);
    weight[u] = cost.weight;
    truncation[u] = cost.truncation;
  }
  if (texture_uncertainty != nullptr) apply_road_plausibility(row, centre, texture_uncertainty, weight);
}

/// The prior from what the rows found, each on its own.
void CoarseSearch::correct_rows(int first, int last, Worker& worker) {
  const auto factor = static_cast<float>(prior_.factor);
  median_of_rows(along_rows_, first, last, prior_.disparity);
  for (int v = first; v < last; ++v) {
    float* row = prior_.disparity.row(v);
    fill_occlusions(row, prior_.disparity.width(), worker.nearest);
    for (int u = 0; u < prior_.disparity.width(); ++u) row[u] *= factor;
  }
}

}  // namespace roadstereo

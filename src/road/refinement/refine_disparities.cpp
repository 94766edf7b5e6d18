#include <algorithm>
#include <array>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/refinement/band_rows.hpp"
#include "road/refinement/band_slopes.hpp"
#include "road/refinement/refinement_maps.hpp"
#include "road/refinement/settings.hpp"
#include "road/refinement/smoothing_bias.hpp"
#include "road/refinement/weighted_mean.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/refinement.hpp"

namespace roadstereo {
namespace {

constexpr int max_lines = 65;

/// Refines row v of a band.
void refine_row(const RefinementInput& maps, const BandRows& rows, const SlopeRow& slopes, const RefinementPass& pass,
                int v, float* mean, float* precision, float* refined, float* error) {
  std::array<WindowLine, max_lines> lines;
  std::size_t count = 0;
  for (int dv = -pass.radius; dv <= pass.radius; dv += pass.step) {
    if (rows.holds(v + dv)) lines[count++] = {rows.row(v + dv), dv, -pass.radius, pass.step};
  }
  const int width = maps.disparity.width();
  weighted_mean(rows.row(v), slopes, {lines.data(), count}, pass.mean, width, mean, precision);
  const RowLine road = row_line(maps.road, v, 0);
  const float* disparity = maps.disparity.row(v);
  const auto worst = static_cast<float>(maps.options.max_sigma_px);
  for (int u = 0; u < width; ++u) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const RefinedPixel pixel =
        refined_pixel(disparity[u], mean[u], precision[u], road.at(static_cast<float>(u)), pass.is_last, worst, nan);
    refined[u] = pixel.disparity;
    error[u] = pixel.error;
  }
}

/// How far from a pixel anything is read in a pass.
int pass_reach(const RefinementPass& pass) {
  return pass.on_slope ? std::max(pass.radius, 2 * pass.slope.step - 1) : pass.radius;
}

void run_pass(const RefinementInput& maps, const RefinementPass& pass, int threads, Image<float>& refined,
              Image<float>& error) {
  const int width = maps.disparity.width(), height = maps.disparity.height();
  refined.resize(width, height);
  error.resize(width, height);
  const std::size_t of_rows = BandRows::numbers(width, pass_reach(pass)),
                    of_slopes = pass.on_slope ? BandSlopes::numbers(pass.slope, width) : 0;
  const std::size_t row_numbers = static_cast<std::size_t>(width) + BandRows::lanes;
  const std::size_t numbers = of_rows + of_slopes + 3 * row_numbers;
  auto scratch = scratch_vector<float>(numbers * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(height, BandRows::band, threads, [&](int first, int last, int worker) {
    float* const own = scratch.data() + numbers * static_cast<std::size_t>(worker);
    float *const mean = own + of_rows + of_slopes, *const precision = mean + row_numbers;
    float* const level = precision + row_numbers;
    std::fill_n(level, row_numbers, 0.0F);
    BandRows rows(maps, pass_reach(pass));
    rows.fill(first, last, own);
    BandSlopes slopes(pass.slope, width);
    if (pass.on_slope) slopes.fill(rows, first, last, own + of_rows);
    for (int v = first; v < last; ++v) {
      const SlopeRow slope = pass.on_slope ? slopes.row(rows.row(v).value, v) : SlopeRow{level, level};
      refine_row(maps, rows, slope, pass, v, mean, precision, refined.row(v), error.row(v));
    }
  });
}

/// Adds the error of smoothing to the standard errors.
void add_smoothing_error(ImageView<const float> disparity, int reach, int threads, Image<float>& sigma) {
  const int width = disparity.width(), height = disparity.height();
  parallel_rows(height, BandRows::band, threads, [&](int first, int last, int) {
    for (int v = std::max(first, reach); v < std::min(last, height - reach); ++v) {
      const float *const above = disparity.row(v - reach), *const below = disparity.row(v + reach);
      const float* const here = disparity.row(v);
      float* const error = sigma.row(v);
      for (int u = reach; u < width - reach; ++u) {
        error[u] = with_smoothing_bias(error[u], here[u], here[u - reach] + here[u + reach], above[u] + below[u]);
      }
    }
  });
}

}  // namespace

void RefinementOptions::validate() const {
  require_range("refinement", "passes", passes, 1, 3);
  require_range("refinement", "radius", radius, 0, 32);
  require_range("refinement", "step", step, 1, 16);
  require_range("refinement", "truncation_sigmas", truncation_sigmas, 0.5, 100.0);
  require_range("refinement", "min_sigma_px", min_sigma_px, 0.001, 1.0);
  require_range("refinement", "smoothing_px", smoothing_px, 0, 32);
  require_range("refinement", "max_sigma_px", max_sigma_px, Above{0.0}, unlimited);
  require_range("refinement", "max_agreement_sigma_px", max_agreement_sigma_px, min_sigma_px, 10.0);
}

void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, int pixel_step,
                        const DisparityPlane& road, double effective_samples, const RefinementOptions& options,
                        int threads, Image<float>& refined, Image<float>& sigma) {
  Image<float> between_disparity, between_variance;
  refine_disparities(disparity, variance, pixel_step, road, effective_samples, options, threads,
                     {between_disparity, between_variance}, refined, sigma);
}

void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, int pixel_step,
                        const DisparityPlane& road, double effective_samples, const RefinementOptions& options,
                        int threads, const RefinementMaps& between, Image<float>& refined, Image<float>& sigma) {
  options.validate();
  require_range("matcher", "pixel_step", pixel_step, 1, 2);
  require_same_size("the disparity map", map_size(disparity), "its variance", map_size(variance));
  RefinementInput maps{disparity, variance, of_matched_pixels(road, pixel_step),
                       of_matched_pixels(options, pixel_step)};
  const double samples = of_matched_pixels(effective_samples, pixel_step);
  const int passes = pass_count(maps.options);
  for (int k = 0; k < passes; ++k) {
    const RefinementPass pass = refinement_pass(maps.options, k, samples);
    const bool to_result = (passes - 1 - k) % 2 == 0;
    Image<float>& out = to_result ? refined : between.disparity;
    Image<float>& error = to_result ? sigma : between.variance;
    run_pass(maps, pass, threads, out, error);
    maps.disparity = out.view();
    maps.variance = error.view();
  }
  if (options.smoothing_px > 0) add_smoothing_error(refined, maps.options.smoothing_px, threads, sigma);
}

}  // namespace roadstereo

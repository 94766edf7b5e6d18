#include <algorithm>
#include <array>
#include <limits>

#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/scratch.hpp"
#include "road/refinement/refinement_maps.hpp"
#include "road/refinement/row_slopes.hpp"
#include "road/refinement/settings.hpp"
#include "road/refinement/smoothing_error.hpp"
#include "road/refinement/weighted_mean.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/refinement.hpp"

namespace roadstereo {
namespace {

constexpr int lanes = 16;  // elements that the kernel may touch behind a row
constexpr int rows_per_band = 32;
constexpr int max_lines = 65;

/// What is refined, and how.
struct Maps {
  ImageView<const float> disparity, variance;
  DisparityPlane road;
  RefinementOptions options;
};

/// How far from a pixel anything is read in a pass.
int reach(const RefinementPass& pass) {
  return std::max(pass.radius, 2 * pass.slope.step - 1);
}

/// The rows of a band and those around them as the kernels read them: heights above the road with room on both sides.
class BandRows {
 public:
  BandRows(const Maps& maps, int reach) : maps_(maps), reach_(reach), pitch_(pitch(maps.disparity.width(), reach)) {}

  static std::ptrdiff_t pitch(int width, int reach) { return width + 2 * std::ptrdiff_t{reach} + lanes; }
  static std::size_t numbers(int width, int reach) {
    return static_cast<std::size_t>(3 * pitch(width, reach) * (rows_per_band + 2 * std::ptrdiff_t{reach}));
  }

  void fill(int first, int last, float* numbers) {
    first_ = std::max(0, first - reach_);
    end_ = std::min(maps_.disparity.height(), last + reach_);
    numbers_ = numbers;
    for (int v = first_; v < end_; ++v) fill_row(v);
  }

  int first() const { return first_; }
  int end() const { return end_; }
  bool holds(int v) const { return v >= first_ && v < end_; }
  MeasuredRow row(int v) const {
    const float* at = numbers_ + 3 * pitch_ * (v - first_) + reach_;
    return {at, at + pitch_, at + 2 * pitch_};
  }

 private:
  void fill_row(int v) {
    const float *disparity = maps_.disparity.row(v), *variance = maps_.variance.row(v);
    const VarianceBounds bounds = variance_bounds(maps_.options);
    const RowLine road = row_line(maps_.road, v, 0);
    float* height = numbers_ + 3 * pitch_ * (v - first_);
    float *precision = height + pitch_, *spread = precision + pitch_;
    const int width = maps_.disparity.width();
    const MeasuredHeight unknown = not_measured();
    const auto fill_sides = [&](float* row, float value) {
      std::fill_n(row, reach_, value);
      std::fill(row + reach_ + width, row + pitch_, value);
    };
    fill_sides(height, unknown.value);
    fill_sides(precision, unknown.precision);
    fill_sides(spread, unknown.variance);
    for (int u = 0; u < width; ++u) {
      const MeasuredHeight pixel = measured(disparity[u], variance[u], road.at(static_cast<float>(u)), bounds);
      height[reach_ + u] = pixel.value;
      precision[reach_ + u] = pixel.precision;
      spread[reach_ + u] = pixel.variance;
    }
  }

  const Maps& maps_;
  int reach_;
  std::ptrdiff_t pitch_;
  int first_ = 0, end_ = 0;
  float* numbers_ = nullptr;
};

/// The slopes of a band's rows: from the means of boxes, and these from sums over columns.
class BandSlopes {
 public:
  BandSlopes(const SlopeSettings& settings, int width)
      : settings_(settings), width_(width), pitch_(BandRows::pitch(width, settings.step)) {}

  static std::size_t numbers(const SlopeSettings& settings, int width) {
    const std::ptrdiff_t pitch = BandRows::pitch(width, settings.step), step = settings.step;
    const std::ptrdiff_t sums = rows_per_band + 2 * (2 * step - 1), boxes = rows_per_band + 2 * step;
    return static_cast<std::size_t>(pitch * (2 * sums + 2 * boxes + 2));
  }

  void fill(const BandRows& rows, int first, int last, float* numbers) {
    const int step = settings_.step, sums = rows_per_band + 2 * (2 * step - 1);
    numbers_ = numbers + 2 * pitch_ * sums;
    top_ = first - step;
    const int first_sum = std::max(first - 2 * step + 1, rows.first());
    const int end_sum = std::min(last + 2 * step - 1, rows.end());
    for (int v = first_sum; v < end_sum; ++v) {
      const MeasuredRow row = rows.row(v);
      sum_columns({row.value, row.precision}, step - 1, -step, width_ + step, sums_of(numbers, v - first_sum));
    }
    for (int v = top_; v < last + step; ++v) {
      const int from = std::max(v - step + 1, first_sum), to = std::min(v + step, end_sum);
      mean_of_rows(sums_of(numbers, from - first_sum), 2 * pitch_, to - from, -step, width_ + step, box_row(v));
    }
  }

  /// Writes behind the boxes: the slopes of one row at a time.
  SlopeRow row(const float* heights, int v) {
    const std::ptrdiff_t boxes = rows_per_band + 2 * std::ptrdiff_t{settings_.step};
    float *const across = numbers_ + 2 * pitch_ * boxes, *const down = across + pitch_;
    row_slopes(heights, {box_row(v), box_row(v - settings_.step), box_row(v + settings_.step)}, settings_, width_,
               across, down);
    return {across, down};
  }

 private:
  BoxRow sums_of(float* numbers, int index) const {
    float* const at = numbers + 2 * pitch_ * index + settings_.step;
    return {at, at + pitch_};
  }
  BoxRow box_row(int v) const { return sums_of(numbers_, v - top_); }

  SlopeSettings settings_;
  int width_;
  std::ptrdiff_t pitch_;
  float* numbers_ = nullptr;  ///< of the boxes
  int top_ = 0;               ///< row of the first boxes
};

/// Refines row v of a band.
void refine_row(const Maps& maps, const BandRows& rows, const SlopeRow& slopes, const RefinementPass& pass, int v,
                float* mean, float* precision, float* refined, float* error) {
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

void run_pass(const Maps& maps, const RefinementPass& pass, int threads, Image<float>& refined, Image<float>& error) {
  const int width = maps.disparity.width(), height = maps.disparity.height();
  refined.resize(width, height);
  error.resize(width, height);
  const std::size_t of_rows = BandRows::numbers(width, reach(pass)), of_slopes = BandSlopes::numbers(pass.slope, width);
  const auto row_numbers = static_cast<std::size_t>(width + lanes);
  const std::size_t numbers = of_rows + of_slopes + 3 * row_numbers;
  auto scratch = scratch_vector<float>(numbers * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int worker) {
    float* const own = scratch.data() + numbers * static_cast<std::size_t>(worker);
    float *const mean = own + of_rows + of_slopes, *const precision = mean + row_numbers;
    float* const level = precision + row_numbers;
    std::fill_n(level, row_numbers, 0.0F);
    BandRows rows(maps, reach(pass));
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
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = std::max(first, reach); v < std::min(last, height - reach); ++v) {
      const float *const above = disparity.row(v - reach), *const below = disparity.row(v + reach);
      const float* const here = disparity.row(v);
      float* const error = sigma.row(v);
      for (int u = reach; u < width - reach; ++u) {
        error[u] = with_smoothing_error(error[u], here[u], here[u - reach] + here[u + reach], above[u] + below[u]);
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
  if (variance.width() != disparity.width() || variance.height() != disparity.height()) {
    fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels and its variance ",
         variance.width(), "×", variance.height(), "; they must be equal");
  }
  Maps maps{disparity, variance, of_matched_pixels(road, pixel_step), of_matched_pixels(options, pixel_step)};
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

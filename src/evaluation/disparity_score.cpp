#include "evaluation/disparity_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/order_statistics.hpp"
#include "core/require_size.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Signed errors of the labelled pixels with a disparity. Adds the number of labelled pixels to `labelled`.
std::vector<double> signed_errors(ImageView<const float> disparity, ImageView<const float> truth,
                                  const std::optional<ImageView<const std::uint8_t>>& mask, std::size_t& labelled) {
  std::vector<double> errors;
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      if (!std::isfinite(truth(u, v)) || (mask && (*mask)(u, v) == 0)) continue;
      ++labelled;
      if (std::isfinite(disparity(u, v))) errors.push_back(double{disparity(u, v)} - double{truth(u, v)});
    }
  }
  return errors;
}

/// Central median of the magnitudes.
double median_magnitude(std::vector<double> errors) {
  for (double& error : errors) error = std::abs(error);
  return central_median(errors);
}

}  // namespace

DisparityScore score_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                               const std::optional<ImageView<const std::uint8_t>>& mask,
                               std::span<const double> tolerances_px) {
  require_same_size("the ground truth", map_size(truth), "the disparity map", map_size(disparity));
  if (mask) require_same_size("the mask", map_size(*mask), "the disparity map", map_size(disparity));
  DisparityScore score;
  const std::vector<double> errors = signed_errors(disparity, truth, mask, score.labelled_pixels);
  score.valid_pixels = errors.size();
  const auto valid = static_cast<double>(errors.size());
  const auto labelled = static_cast<double>(score.labelled_pixels);
  if (labelled > 0) score.density = valid / labelled;
  for (const double tolerance : tolerances_px) {
    if (!(tolerance >= 0)) fail("the tolerance is ", tolerance, " px; it must be at least 0");
    const auto bad = static_cast<double>(
        std::count_if(errors.begin(), errors.end(), [&](double error) { return std::abs(error) > tolerance; }));
    score.bad_share.push_back(valid > 0 ? bad / valid : nan);
    score.bad_or_missing_share.push_back(labelled > 0 ? (bad + labelled - valid) / labelled : nan);
  }
  if (errors.empty()) {
    score.rms_px = score.mean_px = score.sd_px = score.median_px = nan;
    return score;
  }
  double sum = 0, squares = 0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  score.mean_px = sum / valid;
  score.rms_px = std::sqrt(squares / valid);
  score.sd_px = std::sqrt(std::max(0.0, squares / valid - score.mean_px * score.mean_px));
  score.median_px = median_magnitude(errors);
  return score;
}

}  // namespace roadstereo
